"""The torques of joints.csv against what hangs, rests and falls on them, in vacuum: those of motors, springs and limits, in
chains and in loops, with contact and without."""
import math
import unittest

import numpy as np
from jointed_scene import joint, joints_of, run, unseen_box
from test_limits import GRAVITY, limited

HOLD = {"Control": "prescribed", "Target": {"Type": "constant", "Value": 0.}}


def box(size, position, **more):
    """A box of 1 kg."""
    return {"Type": "rigid body", "Geometry": {"Shape": "box", "Size": size}, "Mass": 1., "Position": position, **more}


def arm(step, end, bricks, gravity=0., solids=(), joints=()):
    """Held at its end by a motor, in next to nothing: contact knows only what fluid sees."""
    scene = limited({"A": box((.5, .1), (.45, .4)), **bricks, **dict(solids)},
                    {"H": joint("hinge", ("space", "A"), (.2, .4), **HOLD), **dict(joints)}, step, end, gravity)
    scene["Domain"]["Cells"] = (20, 20)
    scene["Fluid"]["Density"] = 1e-3
    return scene


def links(points):
    """A row of boxes of length 1 from point to point, hinged to space at both ends."""
    names = [f"L{k}" for k in range(len(points) - 1)]
    solids = {}
    for name, one, other in zip(names, points, points[1:]):
        way = np.subtract(other, one)
        solids[name] = {**unseen_box(tuple(np.add(one, other) / 2), 0.), "Rotation": math.atan2(way[1], way[0])}
    ends = ["space", *names, "space"]
    return solids, {f"H{k}": joint("hinge", (ends[k], ends[k + 1]), tuple(map(float, point)))
                    for k, point in enumerate(points)}


PARALLELOGRAM = [(0., 0.), (-math.sin(.1), math.cos(.1)), (1 - math.sin(.1), math.cos(.1)), (1., 0.)]
FIVE_BAR = [(0., 0.), (0., 1.), (.6, 1.8), (1.2, 1.), (1.2, 0.)]


class Torques(unittest.TestCase):
    def test_a_motor_carries_what_rests_on_its_arm(self):
        """A motor carries a load, whether there is a spring elsewhere or not."""
        spring = joint("hinge", ("space", "B"), (.1, .8), **{"Control": "proportional derivative", "Natural Frequency": 5.})
        for more in ((), ({"B": box((.2, .1), (.2, .8))}, {"S": spring})):
            scene = arm(.01, .3, {"Brick": box((.1, .1), (.6, .5))}, GRAVITY, *more)
            rows = joints_of(scene)["H"][5:]
            self.assertAlmostEqual(np.mean([row["torque"] for row in rows]), GRAVITY * (.25 + .4), delta=.02)
            for row in rows:
                self.assertAlmostEqual(row["torque"], GRAVITY * (.25 + .4), delta=.2)  # it rocks in thin air
                self.assertEqual(row["limit_torque"], 0)

    def test_a_motor_and_a_limit_share_a_chain(self):
        solids, hinges = links([(0., 0.), (1., 0.), (2., 0.)])
        hinges.pop("H2")
        hinges["H0"].update(HOLD)
        hinges["H1"]["Limits"] = {"Lower": 0.}
        rows = joints_of(limited(solids, hinges, .02, .2, GRAVITY))
        for one, other in zip(rows["H0"][1:], rows["H1"][1:]):
            self.assertAlmostEqual(one["torque"], 2 * GRAVITY, delta=1e-6)
            self.assertEqual(one["limit_torque"], 0)
            self.assertAlmostEqual(other["limit_torque"], .5 * GRAVITY, delta=1e-6)
            self.assertEqual(other["torque"], 0)

    def test_a_limit_carries_a_parallelogram(self):
        """Whichever of its hinges has it, though three of them follow the others: by virtual work."""
        sign = {"H0": 1, "H1": -1, "H2": 1, "H3": -1}
        for name in sign:
            solids, hinges = links(PARALLELOGRAM)
            hinges[name].update({"Limits": {"Lower": -.4, "Upper": .4}})
            rows = joints_of(limited(solids, hinges, .02, 2., GRAVITY))
            self.assertAlmostEqual(abs(rows[name][-1]["q"]), .4, delta=1e-6)
            angle = .1 + rows["H0"][-1]["q"]  # leans that far to the left
            for other in sign:
                expected = -2 * GRAVITY * math.sin(angle) * sign[name] if other == name else 0.
                self.assertAlmostEqual(rows[other][-1]["limit_torque"], expected, delta=1e-5)

    def test_springs_of_a_loop_pull_as_they_are_bent(self):
        solids, hinges = links(PARALLELOGRAM)
        stiffness = {"H0": 20., "H1": 7., "H2": 11.}
        for name, value in stiffness.items():
            hinges[name].update({"Control": "proportional derivative", "Stiffness": value, "Damping": 2.})
        rows = joints_of(limited(solids, hinges, .05, 20., GRAVITY))
        self.assertGreater(abs(rows["H0"][-1]["q"]), .05)
        for name, value in stiffness.items():
            self.assertAlmostEqual(rows[name][-1]["torque"], -value * rows[name][-1]["q"], delta=1e-4)

    def test_a_motor_and_a_limit_share_a_loop(self):
        """Five bars of two freedoms: one is given, one falls on a limit of a hinge that follows both. The work of gravity
        and of both torques is nothing in all motions that hinges let."""
        for name in ("H1", "H2", "H3", "H4"):
            solids, hinges = links(FIVE_BAR)
            hinges["H0"].update(HOLD)
            hinges[name].update({"Limits": {"Lower": -.2, "Upper": .2}})
            scene = limited(solids, hinges, .02, 3., GRAVITY)
            rows = joints_of(scene)
            _, bodies = run(scene)
            middle = np.array([[body[-1][axis] for axis in "xy"] for body in bodies.values()])
            half, ends = [], [np.zeros(2)]
            for one in middle:  # a hinge is as far before the middle of its link as the next one behind it
                half.append(one - ends[-1])
                ends.append(one + half[-1])
            self.assertLess(np.abs(ends[-1] - FIVE_BAR[-1]).max(), 1e-8)
            turn = np.array([(-arm[1], arm[0]) for arm in half])
            motions = np.linalg.svd(turn.T)[2][2:]  # turns of links that leave the last hinge where it is
            self.assertEqual(len(motions), 2)
            for spin in motions:
                speed = 2 * np.cumsum(spin[:, None] * turn, axis=0) - spin[:, None] * turn
                rate = np.diff(np.concatenate([[0.], spin, [0.]]))
                work = rows["H0"][-1]["torque"] * rate[0] + rows[name][-1]["limit_torque"] * rate[int(name[1])]
                self.assertAlmostEqual(work, GRAVITY * speed[:, 1].sum(), delta=1e-4)
            self.assertGreater(abs(rows[name][-1]["limit_torque"]), .1)


if __name__ == "__main__":
    unittest.main()
