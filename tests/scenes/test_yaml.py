"""Scenes, presets, solver files and studies in YAML: what tools/xml-to-yaml makes of the shipped ones means the same to the bit."""
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests/support"), str(Path(__file__).parent)]
from run_scene import coarse_cells  # noqa: E402
from simulation import attempt, simulate  # noqa: E402

CONVERGE = os.environ.get("LOCKSTEP_CONVERGE", "build/release/drivers/converge")
SMALL = """Dimension: 2
Constants: {n: 8, R: 0.2}
Domain:
  Upper: [1, 2]  # integers are good for numbers
  Cells: ["[n]", "[2*n]"]
Fluid:
  Density: 1e3
  Gravity: [0, -9.8]
  Velocity: ["[0.1*y]", 0]
Defaults:
  Type: rigid body
  Friction: 0
  rigid body: {Density: 500}
Solids:
  Ball:
    Geometry: {Shape: ball, Radius: "[R/copy]"}
    Copies:
      Type: positions
      Points: [0.5, 0.5, 0.5, 1.5]
      Overrides:
        2: {Density: 700}
Time: {Fixed Step: 0.01, Steps: 1}
Output: {Frames: false}
"""
SMALL_XML = """<ParameterList>
  <Parameter name="Dimension" type="int" value="2"/>
  <ParameterList name="Constants">
    <Parameter name="n" type="int" value="8"/>
    <Parameter name="R" type="double" value="0.2"/>
  </ParameterList>
  <ParameterList name="Domain">
    <Parameter name="Upper" type="Array(double)" value="{1, 2}"/>
    <Parameter name="Cells" type="Array(int)" value="{[n], [2*n]}"/>
  </ParameterList>
  <ParameterList name="Fluid">
    <Parameter name="Density" type="double" value="1e3"/>
    <Parameter name="Gravity" type="Array(double)" value="{0, -9.8}"/>
    <Parameter name="Velocity" type="Array(double)" value="{[0.1*y], 0}"/>
  </ParameterList>
  <ParameterList name="Defaults">
    <Parameter name="Type" type="string" value="rigid body"/>
    <Parameter name="Friction" type="double" value="0"/>
    <ParameterList name="rigid body"><Parameter name="Density" type="double" value="500"/></ParameterList>
  </ParameterList>
  <ParameterList name="Solids">
    <ParameterList name="Ball">
      <ParameterList name="Geometry">
        <Parameter name="Shape" type="string" value="ball"/>
        <Parameter name="Radius" type="double" value="[R/copy]"/>
      </ParameterList>
      <ParameterList name="Copies">
        <Parameter name="Type" type="string" value="positions"/>
        <Parameter name="Points" type="Array(double)" value="{0.5, 0.5, 0.5, 1.5}"/>
        <ParameterList name="Overrides">
          <ParameterList name="2"><Parameter name="Density" type="double" value="700"/></ParameterList>
        </ParameterList>
      </ParameterList>
    </ParameterList>
  </ParameterList>
  <ParameterList name="Time">
    <Parameter name="Fixed Step" type="double" value="0.01"/>
    <Parameter name="Steps" type="int" value="1"/>
  </ParameterList>
  <ParameterList name="Output"><Parameter name="Frames" type="bool" value="false"/></ParameterList>
</ParameterList>
"""
STUDY = """<ParameterList name="Study">
  <Parameter name="Scene" type="string" value="small.xml"/>
  <ParameterList name="Constants"><Parameter name="start" type="double" value="0.5"/></ParameterList>
  <ParameterList name="Parameters"><Parameter name="g" type="string" value="Fluid/Gravity[1]"/></ParameterList>
  <Parameter name="Set" type="string" value="Constants/n=[n]; Time/Steps=1"/>
  <ParameterList name="Ladder"><Parameter name="Values" type="Array(double)" value="{8, 16}"/></ParameterList>
  <ParameterList name="Quantities">
    <ParameterList name="speed">
      <Parameter name="Expression" type="string" value="fluid_kinetic_energy - g*dt + start"/>
      <Parameter name="Reference" type="string" value="0.5"/>
    </ParameterList>
  </ParameterList>
</ParameterList>
"""


def convert(xml, yaml):
    subprocess.run([ROOT / "tools/xml-to-yaml", xml, yaml], check=True)


class Yaml(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = Path(scratch.name)

    def used(self, file, *options, ranks=1):
        """The complete list of a run, without the name of its file."""
        output = self.folder / "output"
        simulate(file, output, *options, ranks=ranks)
        return (output / "used-parameters.xml").read_text().split("\n", 1)[1]

    def used_by(self, solver):
        """The complete list with a solver file; what is written does not hang on whether it solves this system."""
        output = self.folder / "output"
        shutil.rmtree(output, ignore_errors=True)
        attempt(self.folder / "small.yaml", output, "--set", f"Solver/File={solver}")
        return (output / "used-parameters.xml").read_text()

    def write(self, **texts):
        for name, text in texts.items():
            stem, kind = name.rsplit("_", 1)
            (self.folder / f"{stem}.{kind}").write_text(text)

    def test_shipped_scenes_mean_the_same(self):
        for kind in ("scenes", "solvers", "presets"):  # paths of scenes are relative
            (self.folder / kind).mkdir()
            for file in (ROOT / "xml-params" / kind).iterdir():
                (self.folder / kind / file.name).symlink_to(file)
        for scene in sorted((self.folder / "scenes").glob("*.xml")):
            with self.subTest(scene.name):
                yaml = scene.with_suffix(".yaml")
                convert(scene, yaml)
                cells = ", ".join(map(str, coarse_cells(scene)))
                options = ["--steps", 1, "--set", f"Domain/Cells={{{cells}}}", "--set", "Output/Frames=false"]
                self.assertEqual(self.used(scene, *options), self.used(yaml, *options))

    def test_solver_files_mean_the_same(self):
        self.write(small_yaml=SMALL)
        for file in sorted((ROOT / "xml-params/solvers").glob("*.xml")):
            with self.subTest(file.name):
                convert(file, self.folder / "solver.yaml")
                (self.folder / "solver.xml").write_text(file.read_text())
                by_xml, by_yaml = (self.used_by(f"solver.{kind}") for kind in ("xml", "yaml"))
                self.assertEqual(by_xml, by_yaml.replace("solver.yaml", "solver.xml"))

    def test_formulas_copies_and_defaults(self):
        self.write(small_yaml=SMALL, small_xml=SMALL_XML)
        expected = self.used(self.folder / "small.xml")
        self.assertEqual(expected, self.used(self.folder / "small.yaml"))
        self.assertIn('name="Ball 2"', expected)
        self.assertEqual(expected, self.used(self.folder / "small.yaml", ranks=2))
        self.assertEqual((self.folder / "output/input.yaml").read_text(), SMALL)
        self.assertFalse((self.folder / "output/input.xml").exists(), "that of the run before")
        setting = ("--set", "Constants/R=0.1", "--set", "Solids/Ball 1/Density=600", "--set", "Solids/Ball/Copies/Points=0.4,0.5,0.4,1.5")
        self.assertEqual(self.used(self.folder / "small.xml", *setting), self.used(self.folder / "small.yaml", *setting))

    def test_files_of_both_kinds_include_each_other(self):
        self.write(small_yaml=SMALL, small_xml=SMALL_XML, top_yml="Include: small.xml\nFluid: {Density: 900}\n",
                   preset_yaml="Solver: {Tolerance: 1e-9}\nFluid: {Viscosity: 1}\n",
                   top_xml='<ParameterList><Parameter name="Include" type="Array(string)" value="{preset.yaml, small.yaml}"/></ParameterList>',
                   two_yaml="Include: [preset.yaml, small.xml]\n")
        included = self.used(self.folder / "top.yml")
        self.assertIn('name="Density" type="double" value="900"', included)
        expected = self.used(self.folder / "small.xml", "--set", "Solver/Tolerance=1e-9", "--set", "Fluid/Viscosity=1")
        for name in ("top.xml", "two.yaml"):  # lists stand in another order
            self.assertEqual(sorted(self.used(self.folder / name).splitlines()), sorted(expected.splitlines()), name)

    def test_a_study(self):
        self.write(small_yaml=SMALL, small_xml=SMALL_XML, study_xml=STUDY)
        convert(self.folder / "study.xml", self.folder / "study.yaml")
        text = (self.folder / "study.yaml").read_text()
        (self.folder / "study.yaml").write_text(text.replace("small.xml", "small.yaml"))
        tables = []
        for kind in ("xml", "yaml"):
            output = self.folder / f"results-{kind}"
            subprocess.run([CONVERGE, self.folder / f"study.{kind}", "--output", output], check=True, capture_output=True)
            rows = (output / "table.csv").read_text().splitlines()
            names = rows[[row.startswith("#") for row in rows].index(False)].split(",")
            column = names.index("value") if "value" in names else names.index("speed")
            tables.append([row.split(",")[column] for row in rows if not row.startswith("#")])
        self.assertEqual(*tables)
        self.assertGreater(len(tables[0]), 2)
        again = subprocess.run([CONVERGE, self.folder / "study.yaml", "--output", self.folder / "results-yaml"],
                               check=True, capture_output=True, text=True)
        self.assertIn("used again", again.stdout)
        self.write(small_yaml=SMALL.replace("1e3", "1.1e3"))  # a scene in YAML counts by its content, too
        anew = subprocess.run([CONVERGE, self.folder / "study.yaml", "--output", self.folder / "results-yaml"],
                              check=True, capture_output=True, text=True)
        self.assertNotIn("used again", anew.stdout)


if __name__ == "__main__":
    unittest.main()
