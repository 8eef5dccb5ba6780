"""Formulas of place and time in place of numbers: what flows are exact with them, and what is said of wrong ones."""
import tempfile
import unittest
from pathlib import Path
import sys

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from scene_xml import xml  # noqa: E402
from simulation import attempt, column, simulate, table  # noqa: E402

AXES = "xyz"


def periodic(dimension):
    return {f"{axis} {end}": {"Type": "periodic"} for axis in AXES[:dimension] for end in ("lower", "upper")}


def scene(dimension, fluid, sides=None, cells=16, step=.01, constants=None):
    domain = {"Cells": (cells,) * dimension, "Sides": sides or {}}
    return xml("Scene", {"Dimension": dimension, "Constants": constants or {}, "Domain": domain, "Fluid": {"Density": 1., **fluid},
                         "Solver": {"Tolerance": 1e-13}, "Time": {"End": 10., "Fixed Step": step}, "Output": {"Frames": False}})


def history(text, steps=3, *options):
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "scene.xml"
        file.write_text(text)
        simulate(file, Path(folder) / "output", "--steps", steps, *options)
        return table(Path(folder) / "output/history.csv")


def down(dimension, g=10.):
    return (0.,) * (dimension - 1) + (-g,)


class AtTheStart(unittest.TestCase):
    def test_a_vortex_decays_at_its_rate(self):
        for dimension in (2, 3):
            with self.subTest(dimension=dimension):
                vortex = ("[U*sin(2*_pi*x)*cos(2*_pi*y)]", "[-U*cos(2*_pi*x)*sin(2*_pi*y)]", "0")[:dimension]
                text = scene(dimension, {"Viscosity": .05, "Velocity": vortex}, periodic(dimension), constants={"U": 2.}).replace(
                    'name="Velocity" type="Array(string)"', 'name="Velocity" type="Array(double)"')
                energy = column(history(text, 10), "fluid_kinetic_energy")
                # U^2/4 in the unit box, by exp(-4 nu k^2 t) with k = 2 pi: e-fold in .127 s.
                self.assertAlmostEqual(energy[-1], 2.718281828459045 ** (-4 * .05 * 39.478 * .1), delta=.03)

    def test_what_has_a_divergence_goes(self):
        for dimension in (2, 3):
            with self.subTest(dimension=dimension):
                potential = ("sin(_pi*x)*cos(_pi*y)", "cos(_pi*x)*sin(_pi*y)", "0")[:dimension]
                self.assertLess(column(history(scene(dimension, {"Velocity": potential}), 1), "fluid_kinetic_energy")[0], 1e-3 * .25)

    def test_a_level_holds_its_volume(self):
        for dimension in (2, 3):
            with self.subTest(dimension=dimension):
                pool = {"Type": "level", "Height": "0.5 + 0.1*cos(2*_pi*x)" + ("*cos(2*_pi*y)" if dimension == 3 else "")}
                rows = history(scene(dimension, {"Gravity": down(dimension), "Free Surface": {"Liquid": {"Pool": pool}}}, cells=32), 1)
                self.assertAlmostEqual(column(rows, "liquid_volume_target")[0], .5, delta=2e-3)

    def test_stratified_fluid_rests(self):
        for dimension in (2, 3):
            up = AXES[dimension - 1]
            for more in ({"Value": f"300 + 5*{up}"},
                         {"Regions": {"All": {"Shape": "box", "Lower": (-1.,) * dimension, "Upper": (2.,) * dimension,
                                              "Value": f"300 + 5*{up}^2"}}}):
                with self.subTest(dimension=dimension, more=more):
                    fluid = {"Gravity": down(dimension), "Thermal Expansion": .1, "Temperature": {"Ambient": 300., **more}}
                    self.assertLess(max(column(history(scene(dimension, fluid)), "fluid_kinetic_energy")), 1e-16)

    def test_a_setting_may_be_a_formula(self):
        for formula in ("{sin(2*_pi*y), 0}", "[sin(2*_pi*y)], 0"):
            with self.subTest(formula):
                rows = history(scene(2, {}, periodic(2)), 1, "--set", f"Fluid/Velocity={formula}")
                self.assertAlmostEqual(column(rows, "fluid_kinetic_energy")[0], .25, delta=1e-9)


class Mistakes(unittest.TestCase):
    def message(self, text):
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "scene.xml"
            file.write_text(text)
            result = attempt(file, Path(folder) / "output")
            self.assertEqual(result.returncode, 2, result.stdout)
            return result.stdout

    def test_all_bad_formulas_are_told_in_one_run(self):
        pool = {"Type": "level", "Height": "1 + "}
        said = self.message(scene(2, {"Velocity": ("x", "w"), "Gravity": down(2), "Free Surface": {"Liquid": {"Pool": pool}}}))
        self.assertIn("There are 2 mistakes", said)
        self.assertIn('in "Fluid", "Velocity": cannot evaluate "w"', said)
        self.assertIn("Known names: x, y.", said)
        self.assertIn('in "Fluid/Free Surface/Liquid/Pool", "Height": cannot evaluate "1 + "', said)
        self.assertRegex(said, r"scene.xml, line \d+")

    def test_only_what_takes_formulas_of_place_and_time_takes_them(self):
        said = self.message(scene(2, {"Viscosity": "[0.1*x]"}).replace('"Viscosity" type="string"', '"Viscosity" type="double"'))
        self.assertIn('"Viscosity" is "[0.1*x]", a formula of place or time, but takes constants only', said)

    def test_a_value_that_is_none_is_told_with_its_place(self):
        pool = {"Type": "level", "Height": "ln(x - 0.5)"}
        said = self.message(scene(2, {"Gravity": down(2), "Free Surface": {"Liquid": {"Pool": pool}}}))
        self.assertIn('In "Fluid/Free Surface/Liquid/Pool", "Height": "ln(x - 0.5)" is', said)
        self.assertIn("It is so at x = ", said)

    def test_old_names(self):
        for fluid in ({"Initial State": {"Type": "uniform"}},
                      {"Gravity": down(2), "Free Surface": {"Liquid": {"Pool": {"Type": "level", "Amplitude": .1}}}}):
            with self.subTest(fluid):
                self.assertRegex(self.message(scene(2, fluid)), r'"(Initial State|Amplitude)" (is gone|stands in)')


if __name__ == "__main__":
    unittest.main()
