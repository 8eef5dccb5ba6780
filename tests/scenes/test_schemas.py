"""Schemas that `simulate --schema` prints: RELAX NG and JSON Schema accept all shipped scenes and presets, and refuse damaged ones."""
import json
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import jsonschema
import yaml

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests/support")]
from simulation import SIMULATE  # noqa: E402

FILES = [*sorted((ROOT / "xml-params/scenes").glob("*.xml")), *sorted((ROOT / "xml-params/presets").glob("*.xml")),
         *sorted((ROOT / "xml-params/studies").glob("*-scene.xml"))]
SCENE = """<ParameterList name="Scene">
  <Parameter name="Dimension" type="int" value="2"/>
  <ParameterList name="Constants"><Parameter name="R" type="double" value="0.3"/></ParameterList>
  <ParameterList name="Domain">
    <Parameter name="Upper" type="Array(double)" value="{1, 2}"/>
    <Parameter name="Cells" type="Array(int)" value="{12, [2*12]}"/>
    <ParameterList name="Sides">
      <ParameterList name="x lower">
        <Parameter name="Type" type="string" value="wall"/>
      </ParameterList>
    </ParameterList>
  </ParameterList>
  <ParameterList name="Fluid">
    <Parameter name="Density" type="double" value="1000"/>
    <Parameter name="Order in Time" type="int" value="2"/>
    <Parameter name="Velocity" type="Array(string)" value="{sin(x), 0}"/>
  </ParameterList>
  <ParameterList name="Solids">
    <ParameterList name="Ball">
      <Parameter name="Type" type="string" value="rigid body"/>
      <ParameterList name="Geometry">
        <Parameter name="Shape" type="string" value="ball"/>
        <Parameter name="Radius" type="double" value="[R]"/>
      </ParameterList>
      <Parameter name="Density" type="double" value="500"/>
      <Parameter name="Position" type="Array(double)" value="{0.5, 0.5}"/>
      <ParameterList name="Copies">
        <Parameter name="Type" type="string" value="lattice"/>
        <Parameter name="Spacing" type="Array(double)" value="{1, 1}"/>
        <ParameterList name="Overrides">
          <ParameterList name="2"><Parameter name="Density" type="double" value="700"/></ParameterList>
        </ParameterList>
      </ParameterList>
    </ParameterList>
  </ParameterList>
  <ParameterList name="Output">
    <Parameter name="Frames" type="bool" value="false"/>
  </ParameterList>
</ParameterList>
"""
# Parts of the scene and what they become.
DAMAGE = [
    ('name="Dimension" type="int" value="2"', 'name="Dimension" type="int" value="4"'),
    ('<ParameterList name="Solids">', '<ParameterList name="Solid">'),
    ('name="Order in Time"', 'name="Order in Tim"'),
    ('name="Density" type="double" value="1000"', 'name="Density" type="double" value="-1"'),
    ('name="Density" type="double" value="1000"', 'name="Density" type="string" value="heavy"'),
    ('name="Density" type="double" value="1000"', 'name="Density" type="bool" value="true"'),
    ('value="{1, 2}"', 'value="{1, 2, 3}"'),
    ('value="wall"', 'value="wal"'),
    ('value="rigid body"', 'value="rigid bodi"'),
    ('value="ball"', 'value="bal"'),
    ('value="lattice"', 'value="random"'),
    ('type="Array(double)" value="{0.5, 0.5}"', 'type="Array(string)" value="{a, b}"'),
    ('name="Density" type="double" value="700"', 'name="Densit" type="double" value="700"'),
    ('type="bool" value="false"', 'type="double" value="0.5"'),
    ('<ParameterList name="Output">', '<ParameterList name="Output"><ParameterList name="More"/>'),
]


def printed(kind):
    return subprocess.run([SIMULATE, "--schema", kind], check=True, capture_output=True, text=True).stdout


def convert(file):
    result = subprocess.run([ROOT / "tools/xml-to-yaml", file], check=True, capture_output=True, text=True)
    return yaml.load(result.stdout, yaml.CSafeLoader)


class Schemas(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = Path(scratch.name)

    def damaged(self):
        for old, new in DAMAGE:
            self.assertIn(old, SCENE)
            (self.folder / "damaged.xml").write_text(SCENE.replace(old, new, 1))
            yield new, self.folder / "damaged.xml"

    def good(self):
        (self.folder / "good.xml").write_text(SCENE)
        return [*FILES, self.folder / "good.xml"]

    def test_relax_ng(self):
        (self.folder / "scene.rng").write_text(printed("xml"))

        def lint(*files):
            return subprocess.run(["xmllint", "--noout", "--relaxng", self.folder / "scene.rng", *files], capture_output=True, text=True)

        result = lint(*self.good())
        self.assertEqual(result.returncode, 0, result.stderr[-4000:])
        self.assertEqual(result.stderr.count("validates"), len(FILES) + 1)
        for new, file in self.damaged():
            with self.subTest(new):
                self.assertEqual(lint(file).returncode, 3, "xmllint's code of what does not validate")

    def test_json_schema(self):
        schema = json.loads(printed("json"))
        jsonschema.Draft7Validator.check_schema(schema)
        validator = jsonschema.Draft7Validator(schema)
        for file in self.good():
            with self.subTest(file.name):
                errors = [f"{list(error.absolute_path)}: {error.message[:300]}" for error in validator.iter_errors(convert(file))]
                self.assertEqual(errors, [])
        for new, file in self.damaged():
            with self.subTest(new):
                self.assertFalse(validator.is_valid(convert(file)))

    def test_documentation(self):
        for kind in ("xml", "json"):
            self.assertIn("[kg/m^3]", printed(kind))
        unknown = subprocess.run([SIMULATE, "--schema", "yaml"], capture_output=True, text=True)
        self.assertEqual(unknown.returncode, 2)


if __name__ == "__main__":
    unittest.main()
