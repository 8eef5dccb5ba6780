"""`Time/Settle`: floating and moored rigid bodies, let go away from their equilibrium, rest from the first step on, as Archimedes has it."""
import math
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from scene_xml import xml  # noqa: E402
from simulation import attempt, column, simulate, table  # noqa: E402

ROOT = Path(__file__).resolve().parents[2]
G, LEVEL, BEAM, DRAFT = 9.81, .7, .4, .1


def scene(dimension, solids, settle=True, **more):
    """A unit tank of still water; vertical is the last axis."""
    return xml("Scene", {
        "Dimension": dimension, "Domain": {"Cells": (24 if dimension == 2 else 16,) * dimension, **more.pop("Domain", {})},
        "Fluid": {"Density": 1000., "Gravity": (0.,) * (dimension - 1) + (-G,),
                  "Free Surface": {"Liquid": {"Pool": {"Type": "level", "Height": LEVEL}}}},
        "Solids": solids, "Solver": {"Tolerance": 1e-11}, "Time": {"End": 100., "Fixed Step": .01, "Settle": settle},
        "Output": {"Frames": False}, **more})


def hull(dimension, **more):
    """A box of half the density of water with ballast, heeled and too high."""
    width = (.3,) * (dimension - 2)
    return {"Type": "rigid body", "Geometry": {"Shape": "box", "Size": (BEAM, *width, 2 * DRAFT)},
            "Position": (.5,) * (dimension - 1) + (LEVEL + .03,), "Rotation": .1 if dimension == 2 else (0., -.1, 0.),
            "Mass": 1000. * BEAM * DRAFT * math.prod(width), "Center of Mass": (0.,) * (dimension - 1) + (-.04,), **more}


class Settle(unittest.TestCase):
    def run_scene(self, text, steps=20, *options, ranks=1):
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "scene.xml"
            file.write_text(text)
            simulate(file, Path(folder) / "output", "--steps", steps, *options, ranks=ranks)
            bodies = {}
            for row in table(Path(folder) / "output/bodies.csv"):
                bodies.setdefault(row["name"], []).append(row)
            return bodies, table(Path(folder) / "output/history.csv")

    def fastest(self, rows):
        return max(max(map(abs, column(rows, name))) for name in ("vx", "vy", "vz", "wx", "wy", "wz") if name in rows[0])

    def test_a_ballasted_hull_rests(self):
        for dimension in (2, 3):
            for coupling in ("flux", "mixed face"):
                with self.subTest(dimension=dimension, coupling=coupling):
                    more = {"Coupling": {"Type": coupling}}
                    bodies, history = self.run_scene(scene(dimension, {"Hull": hull(dimension)}, **more))
                    rows = bodies["Hull"]
                    self.assertLess(self.fastest(rows), 1e-6 * math.sqrt(G * BEAM))
                    self.assertLess(max(column(history, "momentum_error")), 1e-12)
                    # The centre of mass lies .04 m below the middle, which is in the surface.
                    up = "xyz"[dimension - 1]
                    self.assertAlmostEqual(float(rows[-1][up]), LEVEL - .04, delta=1e-3 if coupling == "flux" else .01)
                    # Along the surface only errors of the grid hold it: it had gone half of the tank to where these are zero, or to its side.
                    for along in "xy"[:dimension - 1]:
                        self.assertAlmostEqual(float(rows[-1][along]), .5, delta=1 / 16)

    def test_without_it_the_same_hull_swings(self):
        bodies, _ = self.run_scene(scene(2, {"Hull": hull(2)}, settle=False))
        self.assertGreater(self.fastest(bodies["Hull"]), .05)

    def test_a_moored_buoy_rests(self):
        """The shipped scene: two bodies, a damped spring, two lines on the floor; its waves begin afterwards."""
        bodies, _ = self.run_scene((ROOT / "xml-params/scenes/moored-buoy.xml").read_text().replace(
            "../solvers", str(ROOT / "xml-params/solvers")), 20, "--set", "Time/Settle=true", "--set", "Output/Frames=false",
            "--set", "Domain/Sides/x lower/Wave/Height=1e-9", "--set", "Solver/Tolerance=1e-11")
        for name in ("Buoy", "Lantern"):
            self.assertLess(self.fastest(bodies[name]), 1e-6 * math.sqrt(G * .5), name)

    def test_a_hull_that_would_turn_over_lolls(self):
        """Its equilibrium upright is none that lasts: of wall-sided hulls one at the heel with tan^2 = -2 GM / BM is."""
        bm = BEAM**2 / (12 * DRAFT)
        center, tangent = bm - DRAFT / 2 + .005, math.sqrt(2 * .005 / bm)
        bodies, _ = self.run_scene(scene(2, {"Hull": hull(2, **{"Center of Mass": (0., center), "Rotation": .01})}), 2)
        self.assertLess(self.fastest(bodies["Hull"]), 1e-5)
        # The part below the surface is as large at any heel; the middle of the hull stays in it.
        self.assertAlmostEqual((float(bodies["Hull"][-1]["y"]) - LEVEL) / center, 1 / math.hypot(1, tangent), delta=.01)

    def test_ranks_agree(self):
        places = [self.run_scene(scene(2, {"Hull": hull(2)}), 1, ranks=ranks)[0]["Hull"][-1] for ranks in (1, 2)]
        for name in ("x", "y"):
            self.assertAlmostEqual(float(places[0][name]), float(places[1][name]), delta=1e-6)

    def test_messages(self):
        hinge = {"Hinge": {"Type": "hinge", "Solids": ("space", "Hull"), "Point": (.5, .7)}}
        dry = xml("Scene", {"Dimension": 2, "Domain": {"Cells": (8, 8)}, "Fluid": {"Density": 1000.},
                            "Solids": {"Hull": hull(2)}, "Time": {"Settle": True}})
        for text, words in ((scene(2, {"Hull": hull(2)}, Joints=hinge), '"Time/Settle" does not know joints'),
                            (dry, "there is no gravity")):
            with self.subTest(words), tempfile.TemporaryDirectory() as folder:
                file = Path(folder) / "scene.xml"
                file.write_text(text)
                result = attempt(file, Path(folder) / "output")
                self.assertEqual(result.returncode, 2, result.stdout)
                self.assertIn(words, result.stdout)


if __name__ == "__main__":
    unittest.main()
