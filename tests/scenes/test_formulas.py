"""Formulas of place and time in place of numbers: what flows are exact with them, and what is said of wrong ones."""
import math
import re
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


def channel(dimension, **sides):
    """Sides of a channel along x between walls across y."""
    across = {f"z {end}": {"Type": "periodic"} for end in ("lower", "upper")} if dimension == 3 else {}
    return {**across, **{name.replace("_", " "): side for name, side in sides.items()}}


class Sides(unittest.TestCase):
    def run_scene(self, dimension, cells, fluid, sides, steps, step, observers=None, upper=None, constants=None):
        """Rows of history.csv, and those of the observer "p"."""
        upper = upper or (1.,) * dimension
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "scene.xml"
            file.write_text(xml("Scene", {
                "Dimension": dimension, "Constants": constants or {}, "Domain": {"Upper": upper, "Cells": cells, "Sides": sides},
                "Fluid": {"Density": 2., **fluid}, "Solver": {"Tolerance": 1e-12, "Viscous Solve": {"Tolerance": 1e-12}},
                "Observers": {"p": {"Type": "points", "Points": observers}} if observers else {},
                "Time": {"End": 100., "Fixed Step": step}, "Output": {"Frames": False}}))
            simulate(file, Path(folder) / "output", "--steps", steps)
            return table(Path(folder) / "output/history.csv"), table(Path(folder) / "output/p.csv") if observers else []

    def poiseuille(self, dimension, n):
        """Error of the pressure gradient, -12 mu U / H^2."""
        velocity = ("6*y*(1 - y)",) + ("0",) * (dimension - 1)
        sides = channel(dimension, x_lower={"Type": "inflow", "Velocity": velocity}, x_upper={"Type": "open"})
        cells, upper = (2 * n, n) + (4,) * (dimension - 2), (2., 1.) + (4. / n,) * (dimension - 2)
        points = [x for at in (.5, 1.5) for x in (at, .5, 2. / n)[:dimension]]
        rows, probes = self.run_scene(dimension, cells, {"Viscosity": .5, "Velocity": velocity}, sides, 40, .05, tuple(points), upper)
        self.assertLess(max(column(rows, "momentum_error")), 1e-9)
        before, after = (float(row["pressure"]) for row in probes[-2:])
        self.assertLess(max(abs(float(row["vy"])) for row in probes[-2:]), 1e-3)
        return abs((after - before) / -6 - 1)

    def test_plane_poiseuille_flow_from_a_parabola(self):
        coarse, fine = self.poiseuille(2, 12), self.poiseuille(2, 24)
        self.assertLess(fine, .004)
        self.assertGreater(coarse / fine, 3)
        self.assertLess(self.poiseuille(3, 12), 1.1 * coarse)

    def stokes_layer(self, dimension, n):
        """Largest error of the velocity a period on, of Stokes' second problem between two walls that move as its fluid does."""
        across = (1. / n * 4,) * (dimension - 2)
        layer = "exp(-k*{y})*cos(w*t - k*{y})"
        wall = {end: {"Type": "wall", "Velocity": (f"[{layer.format(y=y)}]",) + ("0",) * (dimension - 1)}
                for end, y in (("lower", 0), ("upper", 1))}
        sides = {f"{a} {end}": {"Type": "periodic"} for a in "xz"[:dimension - 1] for end in ("lower", "upper")}
        constants = {"w": 6.283185307179586, "k": "sqrt(w/(2*0.2))"}
        points = [x for i in range(n) for x in (2. / n, (i + .5) / n, 2. / n)[:dimension]]
        formulas = (f"[{layer.format(y='y').replace('w*t - ', '')}]",) + ("0",) * (dimension - 1)
        text_of = {"Viscosity": .4, "Velocity": formulas}  # nu = .2 m^2/s
        with BracketsAreNumbers():
            _, probes = self.run_scene(dimension, (4, n) + (4,) * (dimension - 2), text_of,
                                       {**sides, "y lower": wall["lower"], "y upper": wall["upper"]}, 2 * n, .5 / n, tuple(points),
                                       (4. / n, 1.) + across, constants)
        k = (6.283185307179586 / .4) ** .5
        return max(abs(float(row["vx"]) - math.exp(-k * float(row["y"])) * math.cos(k * float(row["y"]))) for row in probes[-n:])

    def test_stokes_second_problem(self):
        coarse, fine = self.stokes_layer(2, 16), self.stokes_layer(2, 32)
        self.assertLess(fine, .03)
        self.assertGreater(coarse / fine, 1.8)  # errors of first order in the step
        self.assertLess(self.stokes_layer(3, 16), 1.1 * coarse)

    def channel_rows(self, dimension, lower, upper, steps, step):
        sides = {f"{a} {e}": {"Type": "slip wall"} for a in AXES[1:dimension] for e in ("lower", "upper")}
        sides.update({"x lower": {"Type": "open", **lower}, "x upper": {"Type": "open", **upper}})
        rows, _ = self.run_scene(dimension, (8,) * dimension, {}, sides, steps, step)
        self.assertLess(max(column(rows, "momentum_error")), 1e-9)
        return rows

    def test_a_pressure_that_falls_draws_fluid_out(self):
        """p = -t at the end where it leaves: u = t^2/(2 rho L), all along."""
        for dimension in (2, 3):
            for end in (0, 1):
                with self.subTest(dimension=dimension, end=end):
                    ends = [{"Pressure": "-t"}, {}]
                    rows = self.channel_rows(dimension, ends[end], ends[1 - end], 10, .05)
                    self.assertAlmostEqual(column(rows, "fluid_momentum_x")[-1], (1 if end else -1) * .5 ** 2 / 2, delta=1e-9)

    def test_a_channel_between_two_reservoirs(self):
        """rho L du/dt = p - rho u^2/2: u = U tanh(U t/2L), U = sqrt(2 p/rho) = 1, and never more; by momentum, 2 kg."""
        for dimension in (2, 3):
            for end in (0, 1):
                with self.subTest(dimension=dimension, end=end):
                    ends = [{}, {"Pressure": 1.}]
                    rows = self.channel_rows(dimension, ends[1 - end], ends[end], 160, .1)
                    speed = [(-1 if end else 1) * u / 2 for u in column(rows, "fluid_momentum_x")]
                    self.assertAlmostEqual(speed[-1], 1, delta=1e-6)
                    self.assertLess(max(speed), 1 + 1e-9)
                    for time, u in zip(column(rows, "time"), speed):
                        self.assertAlmostEqual(u, math.tanh(time / 2), delta=.02)

    def test_long_steps_of_what_comes_in_stay_bounded(self):
        """The side takes no more than it has: in steps of c > 1 cells at most sqrt(c) as fast."""
        speed = column(self.channel_rows(2, {"Pressure": 1.}, {}, 60, .5), "fluid_momentum_x")[-1] / 2
        self.assertGreater(speed, 1)
        self.assertLess(speed, 5)

    def test_the_pressure_of_still_water_holds_a_tank_that_is_open(self):
        for dimension in (2, 3):
            for interface in ("level set", "particle level set", "volume of fluid"):
                with self.subTest(dimension=dimension, interface=interface):
                    up = AXES[dimension - 1]
                    side = {"Type": "open", "Pressure": f"2*10*max(0.53 - {up}, 0)"}
                    surface = {"Interface": {"Type": interface}, "Liquid": {"Pool": {"Type": "level", "Height": .53}}}
                    rows, _ = self.run_scene(dimension, (12,) * dimension, {"Gravity": down(dimension), "Free Surface": surface},
                                             {"x lower": side, "x upper": side, f"{up} upper": {"Type": "open"}}, 20, .02)
                    self.assertLess(max(column(rows, "fluid_kinetic_energy")), 1e-14)

    def test_a_higher_tailwater_fills_the_tank_with_liquid(self):
        """By a wave .1 m high, as shallow water has it, and no faster than it falls from there."""
        side = {"Type": "open", "Pressure": "2*10*max(0.6 - y, 0)"}
        surface = {"Liquid": {"Pool": {"Type": "level", "Height": .5}}}
        points = tuple(x for i in range(12) for x in (.02, .02 + .05 * i))
        rows, probes = self.run_scene(2, (48, 48), {"Gravity": down(2), "Free Surface": surface},
                                      {"x lower": side, "y upper": {"Type": "open"}}, 40, .01, points)
        volume = column(rows, "liquid_volume")
        self.assertGreater(volume[-1] - volume[0], .04)  # air came in before, below the level
        self.assertLess(volume[-1] - volume[0], .08)
        self.assertLess(max(float(row["vx"]) for row in probes), 2**.5)

    def test_water_comes_in_no_faster_than_it_falls(self):
        """From a level .5 m above the floor of an empty tank, at sqrt(2 g .5) at most: Torricelli's law."""
        side = {"Type": "open", "Pressure": "2*10*max(0.5 - y, 0)"}
        surface = {"Liquid": {"Pool": {"Type": "box", "Lower": (-1., -1.), "Upper": (.125, .5)}}}
        points = tuple(x for i in range(6) for x in (.03, .04 + .08 * i))
        _, probes = self.run_scene(2, (64, 16), {"Gravity": down(2), "Free Surface": surface},
                                   {"x lower": side, "x upper": {"Type": "open"}, "y upper": {"Type": "open"}}, 150, .01, points, (4., 1.))
        fastest = max(float(row["vx"]) for row in probes)
        self.assertGreater(fastest, .6 * 10 ** .5)
        self.assertLess(fastest, 1.05 * 10 ** .5)

    def test_openings_let_in_what_a_formula_says(self):
        """A pulse of half a second through half of a side."""
        jet = {"Type": "inflow", "Velocity": ("t > 0.5 ? 0 : 16*y*(0.5 - y)", "0"), "Opening": {"Lower": (0., 0.), "Upper": (0., .5)}}
        sides = {"x lower": jet, "x upper": {"Type": "open"}, "y lower": {"Type": "slip wall"}, "y upper": {"Type": "slip wall"}}
        rows, _ = self.run_scene(2, (16, 12), {}, sides, 8, .1, upper=(4 / 3, 1.))
        momentum = column(rows, "fluid_momentum_x")
        # Flow through each section: 16/6 * .5^3 = 1/3, over 4/3 m less half a cell of the inflow; after the pulse none.
        self.assertAlmostEqual(momentum[2], 2 / 3 * (4 / 3 - 1 / 24), delta=1e-8)
        self.assertAlmostEqual(momentum[6], 0, delta=1e-8)


class BracketsAreNumbers:
    """While it is open, `xml` writes texts in brackets as the numbers that a scene takes them for."""
    def __enter__(self):
        self.own, globals()["xml"] = xml, lambda *given: re.sub(
            r'type="(Array\()?string(\)?)" value="(\{?\[[^"]*)"', lambda m: f'type="{m[1] or ""}double{m[2] or ""}" value="{m[3]}"', self.own(*given))

    def __exit__(self, *_):
        globals()["xml"] = self.own


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

    def test_misspelt_constants_get_their_names(self):
        text = scene(2, {"Velocity": ("[UU*y]", "0")}, constants={"U": 2.})
        said = self.message(text.replace('"Velocity" type="Array(string)"', '"Velocity" type="Array(double)"'))
        self.assertIn('Did you mean "U"? Known names: U, x, y.', said)
        said = self.message(scene(2, {"Velocity": ("U*y", "0")}, constants={"U": 2.}))
        self.assertIn('"U*y" names the constant "U", which formulas in brackets know: write "[U*y]" (in XML with type="Array(double)").', said)

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
