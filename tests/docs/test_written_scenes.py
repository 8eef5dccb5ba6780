"""Runs what the pages "write a scene", "write a study" and "five minutes" tell to write, as a reader would.

Usage: test_written_scenes.py ROOT SIMULATE CONVERGE
"""
import csv
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT, SIMULATE, CONVERGE = (Path(argument).resolve() for argument in sys.argv[1:4])
del sys.argv[1:]
END = "</ParameterList>\n"


def blocks(page, language="xml"):
    text = (ROOT / "docs" / page).read_text()
    return re.findall(rf"```{language}\n(.*?)```", text, re.DOTALL)


def with_lists(scene, *lists):
    assert scene.endswith(END)
    return scene[: -len(END)] + "".join(lists) + END


class WrittenScenes(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def write(self, name, text):
        path = Path(self.folder.name) / name
        path.write_text(text)
        return path

    def run_program(self, *arguments):
        result = subprocess.run([str(argument) for argument in arguments], stdout=subprocess.PIPE,
                                stderr=subprocess.STDOUT, text=True, cwd=self.folder.name, timeout=120)
        self.assertEqual(result.returncode, 0, result.stdout)
        return result.stdout

    def assert_couplings_differ(self):
        """The table of the study "rise" has its quantity by both couplings, which are not the same one twice."""
        with (Path(self.folder.name) / "rise" / "table.csv").open() as file:
            rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
        values = {name: [float(row["value"]) for row in rows if row["series"] == name and row["quantity"] == "acceleration"]
                  for name in ("mixed face", "flux")}
        self.assertEqual([len(of) for of in values.values()], [2, 2])
        for mixed_face, flux in zip(*values.values()):
            self.assertGreater(abs(mixed_face - flux), 0.1)

    def test_scene(self):
        box, body, schema, constants, formulas, many, like_another, preset, view = blocks("tutorials/write-a-scene.md")
        numbers = constants[: constants.index("  ...")]
        self.assertIn("valid", self.run_program(SIMULATE, self.write("box.xml", box), "--validate"))
        self.run_program(SIMULATE, self.write("body.xml", with_lists(box, body, view)), "--validate")
        self.run_program(SIMULATE, self.write("completed.xml", schema + box), "--validate")
        in_yaml, schema_of_yaml = blocks("tutorials/write-a-scene.md", "yaml")
        self.run_program(SIMULATE, self.write("box.yaml", schema_of_yaml + in_yaml), "--validate")
        self.run_program(SIMULATE, self.write("many.xml", with_lists(box, numbers, many)), "--steps", "1", "--output", "many")
        velocity, height, force = formulas.splitlines()
        pool = (f'<ParameterList name="Free Surface"><ParameterList name="Liquid"><ParameterList name="Pool"><Parameter name="Type" type="string" value="level"/>'
                f"{height}</ParameterList></ParameterList></ParameterList>")
        named = '<ParameterList name="Constants"><Parameter name="U" type="double" value="1"/><Parameter name="k" type="double" value="3"/></ParameterList>'
        of_place = with_lists(box, named, body).replace('<ParameterList name="Fluid">', '<ParameterList name="Fluid">' + velocity + pool)
        of_place = of_place.replace('<Parameter name="Position"', force + '<Parameter name="Position"')
        self.run_program(SIMULATE, self.write("formulas.xml", of_place), "--validate")
        bodies = (Path(self.folder.name) / "many" / "bodies.csv").read_text()
        self.assertIn("Ball 20", bodies)
        scene = str(ROOT / "xml-params" / "scenes" / "buoyant-spheres.xml")
        self.run_program(SIMULATE, self.write("finer.xml", like_another.replace("xml-params/scenes/buoyant-spheres.xml", scene)),
                         "--validate", "--set", "Domain/Cells={32, 12, 8}")
        self.run_program(SIMULATE, self.write("preset.xml", preset.replace("xml-params/", f"{ROOT}/xml-params/")),
                         "--validate", "--set", "Domain/Cells={32, 12, 8}")

    def test_study(self):
        box, body, *_ = blocks("tutorials/write-a-scene.md")
        time_and_output, study = blocks("tutorials/write-a-study.md")
        self.write("rise-scene.xml", with_lists(box, body, time_and_output))
        self.run_program(CONVERGE, self.write("rise.xml", study), "--output", "rise", "--rungs", "1:2")
        self.assert_couplings_differ()

    def test_five_minutes(self):
        ball, study = blocks("start.md")
        self.run_program(SIMULATE, self.write("ball.xml", ball), "--steps", "2", "--output", "ball")
        self.run_program(CONVERGE, self.write("rise.xml", study), "--output", "rise", "--rungs", "1:2")
        self.assert_couplings_differ()


if __name__ == "__main__":
    unittest.main()
