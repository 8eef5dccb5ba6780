"""Rows of `simulate --explain` on the solids of a scene, its frames and its duration, and its warnings."""
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from scene_xml import xml  # noqa: E402
from simulation import SIMULATE  # noqa: E402

STATIC = {"Motion": {"Type": "static"}}


def box(width, height, x, y, **more):
    return {"Type": "rigid body", "Geometry": {"Shape": "box", "Size": (width, height)}, "Position": (x, y),
            **({} if "Motion" in more else {"Density": 500.}), **more}


SHEET = {"Type": "cloth", "Geometry": {"Shape": "sheet", "Size": (0., .5), "Normal": "x"}, "Young's Modulus": 1e4,
         "Thickness": .01, "Surface Density": 1., "Position": (.8, .5), "Time Integration": "semi-implicit"}


class Explain(unittest.TestCase):
    def explained(self, solids, option="--explain", **content):
        """The rows by their titles, those of solids by their names; the warnings. Nothing may be written."""
        with tempfile.TemporaryDirectory() as folder:
            scene = Path(folder) / "scene.xml"
            scene.write_text(xml("Scene", {"Dimension": 2, "Domain": {"Cells": (16, 16)}, "Solids": solids, **content}))
            result = subprocess.run([SIMULATE, scene, option, "--output", f"{folder}/output"], capture_output=True, text=True)
            self.assertEqual((result.returncode, result.stderr), (0, ""))
            self.assertEqual([path.name for path in Path(folder).iterdir()], ["scene.xml"])
        lines = [line for line in result.stdout.splitlines()[1:] if line]
        rows = {line[:22].strip(): line[22:].strip() for line in lines if not line.startswith("warning")}
        return rows, [line[22:].strip() for line in lines if line.startswith("warning")]

    def test_a_row_a_solid(self):
        rows, warnings = self.explained({"Crate": box(.5, .25, .5, .5), "Sill": box(.25, .25, 0., .75, **STATIC), "Flag": SHEET})
        self.assertRegex(rows["Crate"], r"^62.5 kg, 0.125 m\^2, 0.5 x 0.25 m \(8 x 4 cells\), \d+ segments, dry inside$")
        self.assertRegex(rows["Sill"], r"^prescribed, 0.0625 m\^2, .* dry inside, 50 % of its box outside of the domain$")
        self.assertRegex(rows["Flag"], r"^0.5 kg, 0 x 0.5 m \(0 x 8 cells\), \d+ segments, wet inside, steps of at most .* s \(.*Flag.*\)$")
        self.assertEqual(warnings, [])

    def test_the_default_coupling(self):
        """Fluxes, if all closed solids are thick; it is said why not."""
        crate, slat = box(.5, .25, .5, .5), box(.5, .06, .5, .2)
        for solids, coupling in (({"Crate": crate, "Flag": SHEET}, "flux (automatic: closed solids are not thin), "),
                                 ({"Crate": crate, "Slat": slat}, 'mixed face (automatic: "Slat" is 0.96 cells thick), ')):
            self.assertIn(coupling, self.explained(solids)[0]["coupling"])
        self.assertNotIn("automatic", self.explained({"Crate": crate}, Coupling={"Type": "flux"})[0]["coupling"])

    def test_frames_and_duration(self):
        rows, _ = self.explained({}, Output={"Frame Interval": .25}, Time={"End": 1., "Fixed Step": .1})
        self.assertRegex(rows["frames"], r"^every 0.25 s, 5 x 0.00\d+ MB = 0.0\d+ MB, uncompressed$")
        self.assertRegex(rows["duration"], r"^about .* s: 10 steps of 0.1 s \(Fixed Step\); the first takes .* s$")
        rows, _ = self.explained({}, Time={"End": 1.}, Fluid={"Gravity": (0., -9.8)})
        self.assertRegex(rows["duration"], r"^about .* to .* s: \d+ steps of .* s, as the first.*, to \d+ of .* s, as for what falls")
        self.assertNotIn("duration", self.explained({}, "--validate")[0])

    def test_an_inflow_from_rest_bounds_later_steps(self):
        """At 2 m/s a step of one CFL number crosses a cell of 1/16 m in .031 s."""
        sides = {"x lower": {"Type": "inflow", "Velocity": ("2*min(10*t, 1)", "0")}, "x upper": {"Type": "open"}}
        rows, _ = self.explained({}, Domain={"Cells": (16, 16), "Sides": sides}, Time={"End": 1., "CFL": 1.})
        self.assertRegex(rows["duration"], r", to 32 of 0.0312 s, as for the fastest inflow of the run; ")

    def test_lines(self):
        """They are neither solids nor shells, and end on what holds them."""
        def rope(y):
            return {"Type": "rope", "Solids": ("space", "Crate"), "Points": (.5, 1., .5, y), "Stiffness": 1.}
        rows, warnings = self.explained({"Crate": box(.5, .25, .5, .5), "Rope": rope(.7), "Flag": SHEET})
        self.assertRegex(rows["solids"], r"^2 \(0 prescribed, 1 thin shells\) and 1 lines, ")
        self.assertEqual(rows["Rope"], "a line, which acts on its solids alone")
        self.assertEqual(warnings, [])
        self.assertEqual(self.explained({"Crate": box(.5, .25, .5, .5), "Rope": rope(.875)})[1],
                         ['"Crate" carries what is attached to it up to 0.25 m away from its box'])

    def test_an_empty_tank(self):
        jet = {"Shape": "ball", "Center": (.5, .8), "Radius": .1, "Liquid": True, "Velocity": (0., -1.)}
        surface = {"Interface": {"Type": "particle level set"}}
        rows, _ = self.explained({}, Time={"End": 1.}, Fluid={"Gravity": (0., -9.8), "Sources": {"Jet": jet}, "Free Surface": surface})
        self.assertRegex(rows["duration"], "the first takes .* s$")

    def test_many_solids(self):
        copies = {"Copies": {"Type": "lattice", "Count": (6, 5), "Spacing": (.15, .17)}}
        rows, warnings = self.explained({"Crumb": {**box(.1, .1, .1, .1), **copies}})
        self.assertEqual(sum(name.startswith("Crumb") for name in rows), 20)
        self.assertEqual(len(warnings), 20)
        self.assertEqual(rows[""], "and 10 more")

    def test_warnings(self):
        solids = {"Crumb": box(.1, .5, .5, .5), "Far": box(.25, .25, 3., .5), "Big": box(.25, .25, .25, .25), "Half": box(.25, .25, 1., .8)}
        self.assertEqual(self.explained(solids)[1], [
            '"Crumb" is 1.6 cells across; the fluid sees bodies of two and more',
            '"Far" lies outside of the domain, where there is no fluid',
            '"Half" is free to move, but 50 % of its box lie outside of the domain'])
        pool = {"Gravity": (0., -9.8), "Free Surface": {"Liquid": {"Pool": {"Type": "level", "Height": .75}}}}
        solids = {"Cork": box(.25, .25, .25, .25), "Raft": box(.25, .25, .7, .75), "Stone": {**box(.2, .2, .7, .25), "Density": 3000.}}
        self.assertEqual(self.explained(solids, Fluid=pool)[1],
                         ['"Cork" floats in the liquid, but is all under its surface at the start'])

    def test_soft_bodies_that_bend_and_have_few_elements_across(self):
        def soft(size, spacing):
            return {"Type": "deformable body", "Density": 1000., "Position": (.5, .5), "Material": {"Young's Modulus": 1e6},
                    "Geometry": {"Shape": "box", "Size": size, **({"Mesh Spacing": spacing} if spacing else {})}}
        told = ('"Flap" has about {} of its elements across; linear ones are too stiff in bending, 1 across by a factor of 4, '
                "2 by 75 %, 4 by 19 %, 8 by 5 %")
        for size, spacing, expected in (((.125, .75), .125 / 2, [told.format(2)]), ((.125, .75), .125, [told.format(1)]),
                                        ((.125, .75), .125 / 4, []), ((.125, .75), None, []), ((.25, .25), None, [])):
            self.assertEqual(self.explained({"Flap": soft(size, spacing)})[1], expected)

    def test_what_is_a_little_less_than_two_cells_thick_is_not_called_two(self):
        rows, warnings = self.explained({"Slat": box(.123, .5, .5, .5)})
        self.assertIn('(automatic: "Slat" is 1.97 cells thick)', rows["coupling"])
        self.assertEqual(warnings, ['"Slat" is 1.97 cells across; the fluid sees bodies of two and more'])

    def test_shells_do_not_come_back_through_periodic_sides(self):
        """Told before the run, and once in it, when the first goes through; not where they cannot, nor of held ones, nor of what goes round."""
        sides = {f"x {end}": {"Type": "periodic"} for end in ("lower", "upper")}
        domain = {"Cells": (16, 16), "Sides": sides}
        cup = {"Geometry": {"Shape": "open box", "Size": (.25, .25)}, "Surface Density": 100.}
        fast = {"Cup": {**box(.25, .25, .8, .25, Velocity=(5., 0.)), **cup},
                "Mug": {**box(.25, .25, .8, .7, Velocity=(4., 0.)), **cup},
                "Sill": box(.25, .25, 1., .5, **STATIC)}
        for name in ("Cup", "Mug"):
            del fast[name]["Density"]
        round_and_round = {"Ball": box(.25, .25, .8, .25, Velocity=(5., 0.))}
        warning = ('the domain is periodic along x for fluid and closed solids whose radius and 8 cells fit into half of it: what of "Cup" and other free solids '
                   "goes through such a side meets neither fluid nor solids beyond it")
        self.assertEqual(self.explained(fast, Domain=domain)[1], [warning])
        self.assertEqual(self.explained({"Sill": fast["Sill"]}, Domain=domain)[1], [])
        self.assertEqual(self.explained(round_and_round, Domain={"Cells": (32, 32), "Sides": sides})[1], [])
        self.assertIn('what of "Raft" goes through', self.explained({"Raft": box(.8, .1, .5, .5)}, Domain={"Cells": (32, 32), "Sides": sides})[1][0])
        time = {"End": 1., "Fixed Step": .01, "Steps": 8}
        for solids, sides_there, told in ((fast, domain, 1), ({"Sill": fast["Sill"]}, domain, 0),
                                          (round_and_round, {"Cells": (32, 32), "Sides": sides}, 0),
                                          (fast, {"Cells": (16, 16), "Sides": {f"x {end}": {"Type": "open"} for end in ("lower", "upper")}}, 0)):
            log = self.log(solids, Domain=sides_there, Time=time)
            self.assertEqual(log.count("goes through a periodic side"), told, log)
            if told:  # its edge, at .925 m at the start, is at .975 m after one step and beyond 1 m after two
                self.assertIn('warning: Step 2: "Cup" goes through a periodic side along x.', log)

    def log(self, solids, **content):
        with tempfile.TemporaryDirectory() as folder:
            scene = Path(folder) / "scene.xml"
            scene.write_text(xml("Scene", {"Dimension": 2, "Solids": solids, "Output": {"Frames": False}, "Fluid": {"Density": 1e-3}, **content}))
            result = subprocess.run([SIMULATE, scene, "--output", f"{folder}/output"], capture_output=True, text=True)
            self.assertEqual(result.returncode, 0, result.stderr)
            return result.stdout + result.stderr


if __name__ == "__main__":
    unittest.main()
