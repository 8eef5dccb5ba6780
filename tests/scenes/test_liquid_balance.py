"""Liquid is neither made nor lost: by solids that move in it, by sources, through open sides, between bodies; and drops
keep their energy under surface tension."""
import sys
import tempfile
import unittest
from pathlib import Path
from statistics import mean

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from scene_xml import xml  # noqa: E402
from simulation import attempt, column, simulate, table  # noqa: E402

MODELS = "level set", "particle level set", "volume of fluid"
POOL = {"Pool": {"Type": "level", "Height": .7}}


def scene(cells, upper, surface, step, *, lower=(0., 0.), sides=None, fluid=None, **lists):
    return xml("Scene", {
        "Dimension": 2, "Domain": {"Lower": lower, "Upper": upper, "Cells": cells, "Sides": sides or {}},
        "Fluid": {"Density": 1000., "Gravity": (0., -9.8), "Free Surface": surface, **(fluid or {})},
        "Time": {"End": 100., **step}, "Output": {"Frames": False}, **lists})


def sides(**types):
    return {name.replace("_", " "): {"Type": kind} for name, kind in types.items()}


class LiquidBalance(unittest.TestCase):
    def run_scene(self, text, *options):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "scene.xml"
            path.write_text(text)
            simulate(path, Path(folder) / "out", *options)
            return table(Path(folder) / "out/history.csv")

    def test_a_surface_that_takes_cells_moves_no_volume_to_and_fro(self):
        """A disc sinks by 4.8 cells: volume of fluid moves no more than a tenth of what it displaces."""
        disc = {"Type": "rigid body", "Geometry": {"Shape": "ball", "Radius": .25}, "Position": (.513, .8), "Density": 1.,
                "Motion": {"Type": "sinusoid", "Amplitude": (0., -.15), "Frequency": .5}}
        rows = self.run_scene(
            scene((32, 32), (1., 1.), {"Liquid": POOL, "Interface": {"Type": "volume of fluid"}}, {"Fixed Step": .01},
                  Solids={"Disc": disc}, Coupling={"Type": "flux"}, sides=sides(y_upper="open")), "--end-time", .5)
        self.assertLess(column(rows, "volume_shift")[-1], .1 * .0735)

    def drop(self, model, n):
        """A drop flies over twice its size under surface tension; n cells a metre."""
        surface = {"Surface Tension": .1, "Interface": {"Type": model},
                   "Liquid": {"Drop": {"Type": "ball", "Center": (.51, .503), "Radius": .25}}}
        return scene((2 * n, n), (2., 1.), surface, {"CFL": .5},
                     sides=sides(x_lower="periodic", x_upper="periodic", y_lower="open", y_upper="open"),
                     fluid={"Density": 1., "Gravity": (0., 0.), "Velocity": (1., 0.)})

    def test_a_drop_that_flies_keeps_its_energy(self):
        for model, n in ("level set", 32), ("particle level set", 32), ("volume of fluid", 64):
            with self.subTest(model=model):
                energy = column(self.run_scene(self.drop(model, n), "--end-time", 2), "fluid_kinetic_energy")
                self.assertLess(max(abs(e / energy[0] - 1) for e in energy), .01)

    def test_a_source_gives_its_width_times_its_speed_at_any_step(self):
        width, speed = .2, 1.
        tap = {"Shape": "box", "Lower": (.4, .8), "Upper": (.6, .9), "Liquid": True, "Velocity": (0., -speed)}
        for model, tolerance in ("particle level set", .06), ("volume of fluid", .01):
            for step in .02, .005:
                with self.subTest(model=model, step=step):
                    rows = self.run_scene(scene((50, 50), (1., 1.), {"Interface": {"Type": model}}, {"Fixed Step": step},
                                                fluid={"Sources": {"Tap": tap}}), "--end-time", .36)
                    given = [v for t, v in zip(column(rows, "time"), column(rows, "liquid_volume_target")) if t > .119]
                    self.assertAlmostEqual((given[-1] - given[0]) / (.24 * width * speed), 1, delta=tolerance)
                    self.assertLess(max(column(rows, "momentum_error")), 1e-12)

    def test_a_jet_that_leaves_through_open_sides_does_not_fade(self):
        """It hits a wall and goes off along it, as a film of two cells."""
        jet = {**sides(x_upper="slip wall", y_lower="open", y_upper="open"),
               "x lower": {"Type": "inflow", "Velocity": (1., 0.), "Opening": {"Lower": (-.1, -.05), "Upper": (.1, .05)}}}
        for model in MODELS:
            with self.subTest(model=model):
                rows = self.run_scene(
                    scene((24, 32), (.6, .4), {"Interface": {"Type": model},
                                               "Liquid": {"Start": {"Type": "box", "Lower": (-1., -.05), "Upper": (.1, .05)}}},
                          {"Fixed Step": .02}, lower=(0., -.4), sides=jet,
                          fluid={"Gravity": (0., 0.), "Velocity": (1., 0.)}),
                    "--end-time", 3)
                pushes = [(t, -i / .02) for t, i in zip(column(rows, "time"), column(rows, "boundary_impulse_x"))]
                early, late = (mean(f for t, f in pushes if begin < t <= begin + .5) for begin in (1, 2.5))
                self.assertAlmostEqual(late / 100, 1, delta=.03)
                self.assertAlmostEqual(late / early, 1, delta=.01)

    def test_what_bodies_press_out_between_them_is_kept_and_told(self):
        """Soft blocks sink onto each other, and a soft one is pressed between two rigid ones."""
        soft = {"Type": "deformable body", "Density": 1100., "Time Integration": "fully-implicit",
                "Material": {"Type": "neo-hookean", "Young's Modulus": 5e4, "Poisson's Ratio": .4}}

        def block(x, y, size):
            return {**soft, "Geometry": {"Shape": "box", "Size": (size, size), "Mesh Spacing": .05}, "Position": (x, y)}

        def plate(y, motion):
            return {"Type": "rigid body", "Geometry": {"Shape": "box", "Size": (.5, .1)}, "Density": 1., "Position": (.5, y),
                    "Motion": motion}

        pile = {f"S{i}": block((.3, .5, .7)[i % 3], (.25, .53)[i // 3], .18) for i in range(6)}
        press = {"Soft": block(.5, .4, .3), "Bottom": plate(.15, {"Type": "static"}),
                 "Top": plate(.66, {"Type": "sinusoid", "Amplitude": (0., -.12), "Frequency": .5})}
        for model, solids in ("particle level set", pile), ("volume of fluid", press):
            with self.subTest(model=model), tempfile.TemporaryDirectory() as folder:
                path, out = Path(folder) / "scene.xml", Path(folder) / "out"
                path.write_text(scene((32, 32), (1., 1.), {"Liquid": POOL, "Interface": {"Type": model}},
                                      {"CFL": .9, "Largest Step": .01}, Solids=solids))
                result = attempt(path, out, "--end-time", 1.5)
                self.assertEqual(result.returncode, 0, result.stdout[-2000:])
                rows = table(out / "history.csv")
                target, off = column(rows, "liquid_volume_target"), 0
                self.assertEqual(max(column(rows, "lost_volume")), 0)
                self.assertLess(max(target) - min(target), 1e-10)
                off = max(abs(v / t - 1) for v, t in zip(column(rows, "liquid_volume"), target))
                self.assertEqual(result.stdout.count("is off the target"), 1 if off > 1e-3 else 0)
                self.assertAlmostEqual(column(rows, "liquid_volume")[-1], target[-1], delta=.003 * target[-1])


if __name__ == "__main__":
    unittest.main()
