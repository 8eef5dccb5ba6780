"""Hulls whose mass is not spread evenly: the torque of water at rest about their own centre of mass, in both dimensions, against the
formula of wall-sided hulls, and which of them turn over."""
import math
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from scene_xml import xml  # noqa: E402
from simulation import column, simulate, table  # noqa: E402

G, BEAM, DRAFT, LEVEL = 9.8, .4, .1, .7
BM = BEAM**2 / (12 * DRAFT)  # metacentric radius [m]


def scene(dimension, metacentric_height, heel, coupling="mixed face", **more):
    """A box in a unit tank, half of it in the water: the centre of buoyancy is half a draft below its middle. Vertical is the last axis."""
    center = BM - DRAFT / 2 - metacentric_height  # above the middle
    width = (.3,) * (dimension - 2)
    hull = {"Type": "rigid body", "Geometry": {"Shape": "box", "Size": (BEAM, *width, 2 * DRAFT)}, "Position": (.5,) * (dimension - 1) + (LEVEL,),
            "Rotation": heel if dimension == 2 else (0., -heel, 0.), "Mass": 1000. * BEAM * DRAFT * math.prod(width),
            "Center of Mass": (0.,) * (dimension - 1) + (center,), "Inertia": .5 if dimension == 2 else (.2, .2, .2), **more}
    return xml("Scene", {
        "Dimension": dimension, "Domain": {"Lower": (0.,) * dimension, "Upper": (1.,) * dimension, "Cells": (32 if dimension == 2 else 20,) * dimension},
        "Fluid": {"Density": 1000., "Gravity": (0.,) * (dimension - 1) + (-G,),
                  "Free Surface": {"Liquid": {"Pool": {"Type": "level", "Height": LEVEL}}}},
        "Solids": {"Hull": hull}, "Coupling": {"Type": coupling}, "Solver": {"Tolerance": 1e-10},
        "Time": {"End": 100., "Fixed Step": .005}, "Output": {"Frames": False}})


class Ballast(unittest.TestCase):
    def bodies(self, text, steps):
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "scene.xml"
            file.write_text(text)
            simulate(file, Path(folder) / "output", "--steps", steps)
            history = table(Path(folder) / "output/history.csv")
            self.assertLess(max(column(history, "momentum_error")), 1e-12)
            self.assertLess(max(column(history, "angular_momentum_error")), 1e-12)
            return table(Path(folder) / "output/bodies.csv")

    def test_righting_moment(self):
        """rho g V sin(heel) (GM + BM tan(heel)^2 / 2), by the exact force of water at rest."""
        heel, height, error = .2, .04, 1e-3
        arm = math.sin(heel) * (height + BM * math.tan(heel)**2 / 2)
        for dimension, coupling in ((2, "mixed face"), (2, "flux"), (3, "mixed face"), (3, "flux")):
            weight = 1000. * G * BEAM * DRAFT * (1 if dimension == 2 else .3)
            locked = ("x", "y", "rotation") if dimension == 2 else ("x", "y", "z", "rotation x", "rotation y", "rotation z")
            last = self.bodies(scene(dimension, height, heel, coupling, Locked=locked), 2)[-1]
            with self.subTest(dimension=dimension, coupling=coupling):
                torque = float(last["tz"]) if dimension == 2 else -float(last["ty"])
                self.assertAlmostEqual(torque, -weight * arm, delta=error * weight * arm)

    def test_sign_of_the_metacentric_height(self):
        """GM of + and - 2 cm: the one rights itself, the other heels farther."""
        for dimension in (2, 3):
            for height, sign in ((.02, -1), (-.02, 1)):
                rows = self.bodies(scene(dimension, height, .02), 8)
                with self.subTest(dimension=dimension, height=height):
                    spin = float(rows[-1]["wz"]) if dimension == 2 else -float(rows[-1]["wy"])
                    self.assertGreater(sign * spin, 1e-3)


if __name__ == "__main__":
    unittest.main()
