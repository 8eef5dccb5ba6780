"""Every line of the log says what bounds its step, if it is not the CFL number, and far shorter steps are told once."""
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from scene_xml import xml  # noqa: E402
from simulation import SIMULATE  # noqa: E402

CLOTH = {"Type": "cloth", "Geometry": {"Shape": "sheet", "Size": (0., .4), "Normal": "x"}, "Young's Modulus": 1e8,
         "Thickness": .01, "Surface Density": 1., "Position": (.5, .5), "Velocity": (1., 0.), "Time Integration": "semi-implicit"}
TANK = {"Fluid": {"Gravity": (0., -9.8)}}


def water(**surface):
    liquid = {"Pool": {"Type": "level", "Height": .5}}
    return {"Gravity": (0., -9.8), "Density": 1000., "Free Surface": {"Liquid": liquid, **surface}}


class StepBounds(unittest.TestCase):
    def log(self, content):
        with tempfile.TemporaryDirectory() as folder:
            scene = Path(folder) / "scene.xml"
            scene.write_text(xml("Scene", {"Dimension": 2, "Domain": {"Cells": (8, 8)}, "Output": {"Frames": False}, **content}))
            return subprocess.run([SIMULATE, str(scene), "--output", str(Path(folder) / "output")], check=True, text=True,
                                  stdout=subprocess.PIPE, stderr=subprocess.STDOUT).stdout

    def bounds(self, content):
        """Contents of the brackets in the lines of the steps; empty without."""
        lines = [line for line in self.log(content).splitlines() if re.match(r"step +\d+  t ", line)]
        return [(re.search(r"  dt [\d.]+ \w+ \((.*?)\)  CFL ", line) or [None, ""])[1] for line in lines]

    def test_the_cfl_number_is_not_named(self):
        time = {"End": 1., "Steps": 3, "Largest Step": 9.}
        self.assertEqual(self.bounds({**TANK, "Time": time}), [""] * 3)

    def test_what_the_scene_says(self):
        self.assertEqual(self.bounds({**TANK, "Time": {"End": .025, "Largest Step": .01}}), ["Largest Step", "end of the run", "end of the run"])
        self.assertEqual(self.bounds({**TANK, "Time": {"End": .02, "Fixed Step": .01}}), ["Fixed Step"] * 2)

    def test_waves(self):
        time = {"End": 1., "Steps": 2, "CFL": 4., "Largest Step": 9.}
        self.assertEqual(self.bounds({"Fluid": water(), "Time": time}), ["gravity waves"] * 2)
        self.assertEqual(self.bounds({"Fluid": water(**{"Surface Tension": 1e4}), "Time": time}), ["surface tension"] * 2)

    def test_stiff_elements_and_the_way_out(self):
        """Told in the 20th step, once."""
        content = {"Solids": {"Rope": CLOTH}, "Time": {"End": 1., "Steps": 45}}
        self.assertEqual(self.bounds(content), ["stiffest element of Rope"] * 45)
        log = self.log(content)
        self.assertEqual(log.count("warning: Step 20: for 20 steps the bound by the stiffest element of Rope ("), 1)
        self.assertIn('No element bounds it with "Time Integration" = fully-implicit of that solid. Later steps', log)
        content["Time"]["Steps"] = 19
        self.assertNotIn("warning: ", self.log(content))


if __name__ == "__main__":
    unittest.main()
