"""Errors of joints, and their messages."""
import tempfile
import unittest
from pathlib import Path

from jointed_scene import joint, simulation, tank, unseen_box, vacuum, xml


def message(scene):
    """Exit code and text of a run that fails."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "scene.xml"
        file.write_text(xml("Scene", scene))
        result = simulation.attempt(file, Path(folder) / "output")
        return result.returncode, " ".join(result.stdout.split())


def motor(**target):
    return {"Control": "prescribed", "Target": target}


def square(size, amplitude):
    """Four links of which three motors turn as they please."""
    places = {"A": (.5, 0.), "B": (1., .5), "C": (.5, 1.), "D": (0., .5)}
    solids = {name: {**unseen_box((size * x, size * y), 0.), "Rotation": 0. if name in "AC" else 1.5707963,
                     "Geometry": {"Shape": "box", "Size": (size, .2 * size)}} for name, (x, y) in places.items()}
    corners = {"AB": (size, 0.), "BC": (size, size), "CD": (0., size), "DA": (0., 0.)}
    joints = {name: joint("hinge", tuple(name), corner) for name, corner in corners.items()}
    for name, part in (("AB", 1.), ("BC", .8), ("CD", .6)):
        joints[name].update(motor(Type="sinusoid", Amplitude=part * amplitude, Frequency=.5))
    return solids, joints


class Messages(unittest.TestCase):
    def test_a_loop_that_motors_pull_apart(self):
        solids, joints = square(1., .5)
        joints["tail"] = joint("weld", ("A", "E"), (.5, -.1))  # in no loop
        solids["E"] = unseen_box((.5, -.2), 0.)
        code, text = message(vacuum(solids, joints, .02, 1.))
        self.assertEqual(code, 3, text)
        for part in ("\"AB\"", "\"BC\"", "\"CD\"", "\"DA\"", "loop that cannot close", "a gap of"):
            self.assertIn(part, text)
        self.assertNotIn("tail", text)

    def test_a_small_loop_that_motors_pull_apart(self):
        """A loop of a finger's breadth is pulled apart by less than a millimetre."""
        code, text = message(vacuum(*square(.01, .02), .02, 1.))
        self.assertEqual(code, 3, text)
        self.assertIn("loop that cannot close", text)

    def test_a_motor_that_drives_an_arm_through_the_lid(self):
        """The step went to zero, the energy to 1e19 J."""
        arm = {"Type": "rigid body", "Geometry": {"Shape": "box", "Size": (.06, .6)}, "Density": 2000., "Position": (1., .5)}
        turns = joint("hinge", ("space", "Arm"), (1., .8), **motor(Type="table", Times=(0., 10.), Values=(0., 30.)))
        scene = tank({"Arm": arm}, {"Motor": turns}, "mixed face", step=.01, end=2.)
        scene["Domain"] = {"Upper": (2., 1.), "Cells": (48, 24)}
        del scene["Contact"]
        code, text = message(scene)
        self.assertEqual(code, 3, text)
        for part in ("\"Arm\"", "the side \"y upper\"", "of a cell", "prescribed", "limited torque"):
            self.assertIn(part, text)

    def test_a_ball_that_may_not_turn(self):
        solids = {"A": unseen_box((0., 0., 0.), (1., 2., -1.))}
        code, text = message(vacuum(solids, {"S": joint("ball", ("space", "A"), (.1, .2, 0.), **{"Limits": {"Upper": 0.}})}, .02, 1.))
        self.assertEqual(code, 2, text)
        for part in ("\"S\"", "make it a weld"):
            self.assertIn(part, text)

    def test_kinds_that_need_three_dimensions(self):
        solids = {"A": unseen_box((0., 0.), 1.), "B": unseen_box((1., 0.), 1.)}
        for kind, instead in (("ball", "a ball is a hinge"), ("universal", "\"hinge\""), ("cylinder", "\"slider\""),
                              ("planar", "leave it out")):
            code, text = message(vacuum(solids, {"Neck": joint(kind, ("A", "B"), (.5, 0.))}, .02, 1.))
            self.assertEqual(code, 2, text)
            for part in ("scene.xml", "\"Neck\"", f"\"{kind}\", which needs three dimensions", instead):
                self.assertIn(part, text)

    def test_a_motor_that_shrinks_closed_fluid(self):
        """A piston across a closed tank."""
        piston = {"Type": "rigid body", "Geometry": {"Shape": "box", "Size": (.1, 1.2)}, "Density": 1000., "Position": (.4, .5)}
        push = {"Push": joint("slider", ("space", "Piston"), (.4, .5), Axis=(1., 0.),
                              **motor(Type="sinusoid", Amplitude=.05, Frequency=1.))}
        code, text = message(tank({"Piston": piston}, push, "flux"))
        self.assertEqual(code, 2, text)
        for part in ("cells of fluid are closed in", "the motor \"Push\"", "Open a side of the domain"):
            self.assertIn(part, text)

    def test_a_prescribed_solid_that_shrinks_closed_fluid_through_a_joint(self):
        """A piston on a rod that nobody sees, which goes to and fro."""
        solids = {"Piston": {"Type": "rigid body", "Geometry": {"Shape": "box", "Size": (.1, 1.2)}, "Density": 1000., "Position": (.4, .5)},
                  "Rod": {"Type": "rigid body", "Geometry": {"Shape": "box", "Size": (.2, .05)}, "Position": (.3, .5), "Seen by Fluid": False,
                          "Motion": {"Type": "sinusoid", "Amplitude": (.05, 0.), "Frequency": 1.}}}
        code, text = message(tank(solids, {"Rivet": joint("weld", ("Rod", "Piston"), (.4, .5))}, "flux"))
        self.assertEqual(code, 2, text)
        for part in ("what \"Rod\" carries by joints", "Open a side of the domain"):
            self.assertIn(part, text)
        self.assertNotIn("pins", text)


if __name__ == "__main__":
    unittest.main()
