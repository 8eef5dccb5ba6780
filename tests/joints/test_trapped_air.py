"""Mechanisms beside trapped gas move as the bodies that they stand for."""
import unittest

from jointed_scene import LARGE, joint, run

N_STEPS, STEP = 50, .004


def shaft(solids, joints):
    """Water on a lid on a cushion of gas, which is pressed together at the start."""
    scene = {"Dimension": 2, "Domain": {"Upper": (.25, 1.), "Cells": (8, 32),
                                        "Sides": {**{side: {"Type": "slip wall"} for side in ("x lower", "x upper", "y lower")},
                                                  "y upper": {"Type": "open"}}},
             "Fluid": {"Density": 1000., "Gravity": (0., 0.),
                       "Free Surface": {"Interface": {"Type": "level set", "Volume Correction": "none"},
                                        "Liquid": {"Column": {"Type": "box", "Lower": (-1., .5), "Upper": (2., .8)}},
                                        "Trapped Air": "ideal gas", "Atmospheric Pressure": 1e4, "Gas Pressure": 3000.}},
             "Contact": {"Type": "none"}, "Coupling": {"Type": "flux"}, "Solids": solids,
             "Time": {"End": N_STEPS * STEP, "Fixed Step": STEP}, "Output": {"Frames": False}, "Solver": {"Tolerance": 1e-11}}
    if joints:
        scene["Joints"] = joints
        scene["Time"]["Largest Turn"] = LARGE
    return scene


def lid(bottom, height, **more):
    return {"Type": "rigid body", "Geometry": {"Shape": "box", "Size": (.5, height)}, "Density": 2000.,
            "Position": (.125, bottom + .5 * height), **more}


LOCKED = {"Locked": ("x", "rotation")}


class TrappedAir(unittest.TestCase):
    def setUp(self):
        _, bodies = run(shaft({"Lid": lid(.4, .1, **LOCKED)}, {}))
        self.lid = bodies["Lid"]
        heights = [row["y"] for row in self.lid]
        self.assertGreater(max(heights) - min(heights), .01)  # the gas lifts it

    def expect_lid(self, rows, offset, bound):
        for row, expected in zip(rows, self.lid):
            self.assertAlmostEqual(row["y"] - offset, expected["y"], delta=bound)

    def test_a_lid_cut_in_two_is_the_whole(self):
        """The lower half feels the gas, the upper one the water."""
        halves = {"Lower": lid(.4, .05), "Upper": lid(.45, .05)}
        weld = {"W": joint("weld", ("Lower", "Upper"), (.125, .45))}
        for ranks in (1, 2):
            history, bodies = run(shaft(halves, weld), ranks)
            self.expect_lid(bodies["Lower"], -.025, 1e-9)
            self.expect_lid(bodies["Upper"], .025, 1e-9)
            self.assertLess(max(row["momentum_error"] for row in history), 1e-12)

    def test_a_slider_is_a_lock(self):
        slider = {"S": joint("slider", ("space", "Lid"), (.125, .45), Axis=(0., 1.))}
        history, bodies = run(shaft({"Lid": lid(.4, .1)}, slider))
        self.expect_lid(bodies["Lid"], 0., 1e-9)
        self.assertLess(max(row["momentum_error"] for row in history), 1e-12)

    def test_a_hinge_carries_what_the_gas_pushes(self):
        hinge = {"H": joint("hinge", ("space", "Lid"), (.125, .45))}
        history, bodies = run(shaft({"Lid": lid(.4, .1)}, hinge))
        self.assertLess(max(abs(row["y"] - .45) for row in bodies["Lid"]), 1e-12)
        self.assertLess(max(row["momentum_error"] for row in history), 1e-12)


if __name__ == "__main__":
    unittest.main()
