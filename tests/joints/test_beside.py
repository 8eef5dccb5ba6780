"""Solids that no joint touches move as they do without joints, and mechanisms as they do without one another."""
import unittest

import free_chain
from joint_cases import CHAIN, CHAIN_JOINTS
from jointed_scene import joint, joints_of, run, tank, unseen_box, vacuum

CURTAIN = {"Type": "cloth", "Geometry": {"Shape": "sheet", "Size": (0., .4), "Normal": "x"}, "Young's Modulus": 1e3, "Thickness": .001,
           "Surface Density": 2., "Stretch Limit": .1, "Position": (.75, .65), "Time Integration": "fully-implicit",
           "Pinned": {"Rod": {"Lower": (0., .2), "Upper": (0., .2)}}}


class Beside(unittest.TestCase):
    def test_a_cloth_at_its_stretch_limit(self):
        """Its weight would stretch it eightfold. Joints have the motion solved again in each step, and it is limited anew."""
        solids = {"Curtain": CURTAIN, "A": unseen_box((0., .2), 20.), "B": unseen_box((1., .2), -30.)}
        without, joined = (run(tank(solids, joints, "mixed face"))[1]["Curtain"]
                           for joints in ({}, {"AB": joint("hinge", ("A", "B"), (.5, .2))}))
        self.assertGreater(len(without), 5)
        for one, other in zip(without, joined):
            for name in ("x", "y", "vx", "vy"):
                self.assertAlmostEqual(one[name], other[name], delta=1e-7, msg=f"{name} at {one['time']} s")

    def check_flight(self, bodies):
        """The chain's energy."""
        inertia, start = free_chain.MASSES[2, 2], free_chain.energy(free_chain.start()[1])
        for rows in zip(*(bodies[name] for name in "ABC")):
            energy = sum(row["vx"] ** 2 + row["vy"] ** 2 + inertia * row["wz"] ** 2 for row in rows) / 2
            self.assertAlmostEqual(energy / start, 1, delta=.012)

    def test_a_ball_on_the_floor(self):
        """It stands in it, and is pushed out; a chain that each step turns by up to 1 and 4 rad flies all the same."""
        ball = {"Type": "rigid body", "Geometry": {"Shape": "ball", "Radius": .1}, "Mass": 1., "Position": (.5, .05), "Force": (0., -1.)}
        for step in (.5, 2.):
            with self.subTest(step=step):
                scene = vacuum({**CHAIN, "Ball": ball}, CHAIN_JOINTS, step, 10 * step)
                scene.update({"Contact": {"Type": "gauss seidel"}, "Coupling": {"Type": "flux"}, "Solver": {"Tolerance": 1e-6}})
                history, bodies = run(scene)
                self.assertGreater(sum(row["contacts"] > 0 for row in history), 4)
                self.check_flight(bodies)
                self.assertEqual({row["two_halves"] for rows in joints_of(scene).values() for row in rows}, {1})

    def test_a_mechanism_that_flies(self):
        """A chain that a step turns by up to 1 and 4 rad, beside a pendulum whose joint gives all of its impulse at the end of the
        step, since a spring or a limit is there: it flies all the same, and keeps its energy."""
        for name, more in (("spring", {"Control": "proportional derivative", "Stiffness": 1e-9}), ("limit", {"Limits": {"Upper": 1e4}})):
            for step in (.5, 2.):
                with self.subTest(beside=name, step=step):
                    solids = {**CHAIN, "P": {**unseen_box((0., 3.5), 20.), "Torque": 20.}}
                    scene = vacuum(solids, {**CHAIN_JOINTS, "H": joint("hinge", ("space", "P"), (-.5, 3.5), **more)}, step, 20 * step)
                    scene["Contact"] = {"Type": "gauss seidel"}
                    _, bodies = run(scene)
                    self.check_flight(bodies)
                    halves = joints_of(scene)
                    self.assertEqual({row["two_halves"] for name in ("AB", "BC") for row in halves[name]}, {1})
                    self.assertEqual({row["two_halves"] for row in halves["H"][1:]}, {0})


if __name__ == "__main__":
    unittest.main()
