"""Steps that turn bodies much too far gain no energy: free, at limits, in contact, with heavy and light partners, with joints
that say nothing new. docs/results/joints.md has the figures that these bounds are half as large again as."""
import unittest

from stability_cases import CONDITIONS, MECHANISMS, thrown

FLAT = ("three links, hinges", "two links on a nail")
N_STEPS = 20


class Stability(unittest.TestCase):
    def check(self, mechanism, condition, bounds):
        for turn, result in thrown(mechanism, condition, bounds, N_STEPS).items():
            with self.subTest(mechanism=mechanism, condition=condition, turn=turn):
                self.assertLess(result["gain"], bounds[turn])
                self.assertLess(result["momentum"], 1e-9)

    def test_what_is_flat(self):
        """Above half a radian all of a joint's impulse acts at the end of the step, which takes energy from each."""
        for mechanism in FLAT:
            for condition in CONDITIONS:
                self.check(mechanism, condition, {.2: .045, .5: 0., 4.: 0.})

    def test_what_is_not(self):
        """There a body's own turning may gain energy above a radian a step, without any joint."""
        for mechanism in MECHANISMS:
            if mechanism not in (*FLAT, "a body alone"):
                for condition in CONDITIONS:
                    self.check(mechanism, condition, {.2: .045})


if __name__ == "__main__":
    unittest.main()
