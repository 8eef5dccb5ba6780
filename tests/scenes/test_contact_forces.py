"""Forces of contact in bodies.csv: what a body gives to a held or scripted one is there, opposite and equal, with its torque."""
import math
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from scene_xml import xml  # noqa: E402
from simulation import column, histories  # noqa: E402

G = 9.8
MASS = 2.


def scene(dimension, solids, **more):
    """A unit tank of next to nothing; vertical is the last axis."""
    return xml("Scene", {
        "Dimension": dimension, "Domain": {"Upper": (1.,) * dimension, "Cells": (16,) * dimension},
        "Fluid": {"Density": 1e-6, "Gravity": (0.,) * (dimension - 1) + (-G,)}, "Solids": solids, "Solver": {"Tolerance": 1e-10},
        "Contact": {"Tolerance": 1e-9}, "Output": {"Frames": False},
        **more, "Time": {"End": 100., "Fixed Step": .005, **more.get("Time", {})}})


def box(size, position, **more):
    return {"Type": "rigid body", "Geometry": {"Shape": "box", "Size": size}, "Position": position, **more}


def of(rows, name):
    return [row for row in rows if row["name"] == name]


class ContactForces(unittest.TestCase):
    def assert_opposite(self, bodies, one, other, dimension=2):
        """In every row, with torques about one point, to 1e-9 of the weight."""
        tiny = 1e-9 * MASS * G
        for first, second in zip(of(bodies, one), of(bodies, other)):
            force = [[float(row[f"contact_f{axis}"]) for axis in "xyz"[:dimension]] for row in (first, second)]
            for a in range(dimension):
                self.assertAlmostEqual(force[0][a], -force[1][a], delta=tiny)
            if dimension == 2:
                torque = [float(row["contact_tz"]) + float(row["x"]) * fy - float(row["y"]) * fx
                          for row, (fx, fy) in zip((first, second), force)]
                self.assertAlmostEqual(torque[0], -torque[1], delta=tiny)
        return force[1]

    def shelves(self, dimension):
        """The ways to hold one."""
        size, position = ((.6, .1), (.5, .45)) if dimension == 2 else ((.6, .6, .1), (.5, .5, .45))
        turns = ("rotation",) if dimension == 2 else ("rotation x", "rotation y", "rotation z")
        yield "static", box(size, position, Motion={"Type": "static"})
        yield "locked", box(size, position, Mass=1., Locked=tuple("xyz"[:dimension]) + turns)
        up = (0.,) * (dimension - 1) + (.1,)
        yield "scripted", box(size, position, Motion={"Type": "constant velocity"}, Velocity=up)

    def test_the_weight_of_a_stone_is_on_its_shelf(self):
        for dimension in (2, 3):
            size, position = ((.2, .2), (.6, .6)) if dimension == 2 else ((.2, .2, .2), (.6, .6, .6))
            vertical = dimension - 1
            for name, shelf in self.shelves(dimension):
                for coupling in ("mixed face", "flux") if dimension == 2 else ("flux",):
                    with self.subTest(name, dimension=dimension, coupling=coupling):
                        stone = box(size, position, Mass=MASS, Velocity=shelf.get("Velocity", (0.,) * dimension))
                        _, bodies = histories(scene(dimension, {"Shelf": shelf, "Stone": stone}, Coupling={"Type": coupling}), "--steps", 10)
                        on_shelf = self.assert_opposite(bodies, "Stone", "Shelf", dimension)
                        self.assertAlmostEqual(on_shelf[vertical], -MASS * G, delta=1e-4 * MASS * G)

    def test_a_stone_on_a_stone_on_a_shelf(self):
        """Half of the weight goes through the one in between."""
        shelf = box((.6, .1), (.5, .25), Motion={"Type": "static"})
        solids = {"Shelf": shelf, "Lower": box((.2, .2), (.5, .4), Mass=MASS), "Upper": box((.2, .2), (.5, .6), Mass=MASS)}
        for order in (1, 2):
            with self.subTest(order=order):
                _, bodies = histories(scene(2, solids, Time={"Order in Time": order}), "--steps", 10)
                last = {name: float(of(bodies, name)[-1]["contact_fy"]) for name in solids}
                for name, weights in (("Shelf", -2), ("Lower", 1), ("Upper", 1)):
                    self.assertAlmostEqual(last[name], weights * MASS * G, delta=1e-4 * MASS * G)

    def test_friction_is_on_an_inclined_plate(self):
        """A stone that sticks gives its weight, one that slides its pressure and so much of that along the plate."""
        slope = math.radians(20)
        normal, down = (-math.sin(slope), math.cos(slope)), (-math.cos(slope), -math.sin(slope))
        for held in ({"Motion": {"Type": "static"}}, {"Mass": 1., "Locked": ("x", "y", "rotation")}):
            plate = box((.8, .1), (.5, .4), Rotation=slope, Friction=.5, **held)
            place = tuple(x + .15 * n for x, n in zip((.5, .4), normal))
            for friction in (.5, .1):
                with self.subTest(friction=friction, **held):
                    plate["Friction"] = friction
                    stone = box((.2, .2), place, Rotation=slope, Friction=friction, Mass=MASS)
                    _, bodies = histories(scene(2, {"Plate": plate, "Stone": stone}), "--steps", 20)
                    force = self.assert_opposite(bodies, "Stone", "Plate")
                    pressure = -sum(a * b for a, b in zip(force, normal))
                    along = sum(a * b for a, b in zip(force, down))
                    self.assertAlmostEqual(pressure, MASS * G * math.cos(slope), delta=1e-4 * MASS * G)
                    wanted = math.tan(slope) if friction > math.tan(slope) else friction
                    self.assertAlmostEqual(along / pressure, wanted, delta=1e-4)
                    self.assertEqual(max(column(of(bodies, "Plate"), "vx")), 0)

    def test_nothing_touches_nothing(self):
        solids = {"Shelf": box((.6, .1), (.5, .25), Motion={"Type": "static"}), "Stone": box((.2, .2), (.5, .7), Mass=MASS)}
        _, bodies = histories(scene(2, solids), "--steps", 5)
        self.assertEqual({row[name] for row in bodies for name in ("contact_fx", "contact_fy", "contact_tz")}, {"0"})

    def test_two_ranks_agree(self):
        solids = dict(Shelf=next(self.shelves(2))[1], Stone=box((.2, .2), (.6, .6), Mass=MASS))
        runs = [histories(scene(2, solids), "--steps", 5, ranks=ranks)[1] for ranks in (1, 2)]
        for one, other in zip(*runs):
            self.assertAlmostEqual(float(one["contact_fy"]), float(other["contact_fy"]), delta=1e-6 * MASS * G)


if __name__ == "__main__":
    unittest.main()
