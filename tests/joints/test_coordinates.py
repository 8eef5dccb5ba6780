"""Coordinates of a joint that are controlled one by one: what is driven goes where it is told, and what is free moves as the
equations of motion have it."""
import math
import unittest

import numpy as np
from jointed_scene import joint, joints_of, unseen_box, vacuum
from test_messages import message

SWING = {"Type": "sinusoid", "Amplitude": .8, "Frequency": .5}


def driven(**target):
    return {"Control": "prescribed", "Target": target}


def cylinder(step=.05, end=1., push=0., **more):
    """A box that slides along z and turns about it, beside its middle; something pushes along z."""
    box = {**unseen_box((.3, .2, 0.), (0., 0., 0.)), "Velocity": (0., 0., .4), "Force": (0., 0., push)}
    return vacuum({"A": box}, {"C": joint("cylinder", ("space", "A"), (0., 0., 0.), Axis=(0., 0., 1.), **more)}, step, end)


def universal(step, **more):
    """A box on a cross at its middle, which turns by 2 rad/s about x; it begins to turn about y too."""
    box = unseen_box((0., 0., 0.), (2., .5, 0.))
    cross = joint("universal", ("space", "A"), (0., 0., 0.), **{"Axis": (1., 0., 0.), "Second Axis": (0., 1., 0.)}, **more)
    return vacuum({"A": box}, {"U": cross}, step, 2.)


SPIN = driven(Type="table", Times=(0., 10.), Values=(0., 20.))


def second_angle(time):
    """I2 q'' = w^2 (I3 - I1) sin q cos q of a box that is turned by w = 2 rad/s, by Runge and Kutta's method."""
    i1, i2, i3 = (.04 + .09) / 12, (1 + .09) / 12, (1 + .04) / 12
    step, state = 1e-3, np.array([0., .5])

    def rate(s):
        return np.array([s[1], 4 * (i3 - i1) / i2 * math.sin(s[0]) * math.cos(s[0])])
    for _ in range(round(time / step)):
        k1 = rate(state)
        k2 = rate(state + step / 2 * k1)
        k3 = rate(state + step / 2 * k2)
        state = state + step / 6 * (k1 + 2 * k2 + 2 * k3 + rate(state + step * k3))
    return state[0]


class Coordinates(unittest.TestCase):
    def test_a_driven_turn_leaves_a_free_slide_alone(self):
        rows = joints_of(cylinder(push=1.5, **{"Coordinate 2": driven(**SWING)}))
        for slide, turn in zip(rows["C 1"], rows["C 2"]):
            time = slide["time"]
            self.assertAlmostEqual(slide["q"], .4 * time + .75 * time ** 2, delta=1e-11)
            self.assertAlmostEqual(turn["q"], .8 * math.sin(math.pi * time), delta=1e-11)
            self.assertEqual(slide["target"], slide["q"])
            self.assertEqual(slide["torque"], 0)
        self.assertGreater(max(abs(row["torque"]) for row in rows["C 2"]), .1)

    def test_a_driven_slide_leaves_a_free_turn_alone(self):
        scene = cylinder(push=1.5, **{"Coordinate 1": driven(**SWING)})
        scene["Solids"]["A"]["Torque"] = (0., 0., .2)
        scene["Solids"]["A"]["Velocity"] = (0., 0., 0.)
        for step, bound in ((.05, 2e-3), (.025, 5e-4)):  # it goes about the axis
            scene["Time"]["Fixed Step"] = step
            rows = joints_of(scene)
            inertia = 1.04 / 12 + .13
            self.assertAlmostEqual(rows["C 1"][-1]["q"], .8 * math.sin(math.pi), delta=1e-11)
            self.assertAlmostEqual(rows["C 2"][-1]["q"], .2 / inertia / 2, delta=bound)

    def test_each_coordinate_has_a_law_of_its_own(self):
        """A spring along the axis, critically damped, and the rate of an oscillator about it."""
        control = {"Coordinate 1": {"Control": "proportional derivative", "Natural Frequency": 1., "Target": {"Type": "constant", "Value": .7}},
                   "Coordinate 2": {"Control": "prescribed rate", "Natural Frequency": 2., "Target": {"Type": "constant", "Value": 1.}}}
        scene = cylinder(.125, 2., **control)
        scene["Solids"]["A"]["Velocity"] = (0., 0., 0.)
        rows = joints_of(scene)
        self.assertAlmostEqual(rows["C 1"][-1]["q"], .7 * (1 - 3 * math.exp(-2)), delta=.00053)
        for row in rows["C 2"]:
            time = row["time"]
            self.assertAlmostEqual(row["q"], 1 - (1 + 2 * time) * math.exp(-2 * time), delta=1e-10)

    def test_a_cross_that_is_driven_about_one_axis(self):
        errors = []
        for step in (.04, .02):
            rows = joints_of(universal(step, **{"Coordinate 1": SPIN}))
            for row in rows["U 1"]:
                self.assertAlmostEqual(row["q"], 2 * row["time"], delta=1e-10)
            errors.append(abs(rows["U 2"][-1]["q"] - second_angle(2.)))
        self.assertGreater(rows["U 2"][-1]["q"], 1.)
        self.assertLess(errors[1], 2e-3)
        self.assertGreater(math.log2(errors[0] / errors[1]), 1.8)

    def test_what_is_said_of_one_goes_before_what_is_said_of_all(self):
        both = {"Control": "prescribed", "Target": {"Type": "table", "Times": (0., 10.), "Values": (0., 0., 20., 3.)}}
        of_all = joints_of(universal(.04, **both, **{"Coordinate 2": {"Control": "free"}}))
        of_one = joints_of(universal(.04, **{"Coordinate 1": SPIN}))
        for name in ("U 1", "U 2"):
            self.assertAlmostEqual(of_all[name][-1]["q"], of_one[name][-1]["q"], delta=1e-12)

    def test_each_coordinate_has_limits_of_its_own(self):
        scene = cylinder(**{"Coordinate 1": {"Limits": {"Upper": .1}}, "Coordinate 2": driven(**SWING)})
        scene["Contact"] = {"Type": "gauss seidel"}
        rows = joints_of(scene)
        self.assertAlmostEqual(rows["C 1"][-1]["q"], .1, delta=1e-9)
        self.assertAlmostEqual(rows["C 2"][-1]["q"], .8 * math.sin(math.pi), delta=1e-9)

    def test_limits_alone_leave_the_control_of_the_joint(self):
        spring = {"Control": "proportional derivative", "Natural Frequency": 3.}
        scenes = [cylinder(**spring), cylinder(**spring, **{"Coordinate 1": {"Limits": {"Upper": 9.}}})]
        scenes[1]["Contact"] = {"Type": "gauss seidel"}
        alone, limited = map(joints_of, scenes)
        self.assertLess(abs(alone["C 1"][-1]["q"]), .1)  # free, it would be at .4
        for name in ("C 1", "C 2"):
            self.assertAlmostEqual(alone[name][-1]["q"], limited[name][-1]["q"], delta=1e-12)

    def test_messages(self):
        for more, parts in (({"Coordinate 2": {**driven(**SWING), "Limits": {"Upper": 1.}}}, ("\"C\"", "prescribed", "limits of coordinate 2")),
                            ({"Coordinate 1": {"Control": "prescribed rate"}}, ("\"C/Coordinate 1\"", "Natural Frequency")),
                            ({"Coordinate 3": {"Control": "free"}}, ("Coordinate 3", "is not a parameter"))):
            code, text = message(cylinder(**more))
            self.assertEqual(code, 2, text)
            for part in parts:
                self.assertIn(part, text)
        solids = {"A": unseen_box((0., 0., 0.), (0., 0., 0.))}
        code, text = message(vacuum(solids, {"B": joint("ball", ("space", "A"), (.1, 0., 0.), **{"Coordinate 1": {"Control": "free"}})}, .1, 1.))
        self.assertEqual(code, 2, text)
        self.assertIn("is not a parameter", text)


if __name__ == "__main__":
    unittest.main()
