"""Solids that no joint touches move as they do without joints."""
import unittest

from jointed_scene import joint, run, tank, unseen_box

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


if __name__ == "__main__":
    unittest.main()
