"""Steps that turn bodies much too far gain no energy: free, at limits, in contact, with heavy and light partners, with joints
that say nothing new. docs/results/joints.md has the figures, of more turns and steps."""
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

    def test_mechanisms_and_a_body_alone(self):
        """What nothing else acts on keeps its energy: a body to round-off, joints by their own small parts of a step. Limits
        take energy; above half a radian all of a joint's impulse acts at the end of the step there."""
        self.check("a body alone", "free", {turn: 1e-11 for turn in (.5, 1., 4.)})
        for mechanism in MECHANISMS:
            if mechanism != "a body alone":
                for condition in CONDITIONS:
                    bounds = {.2: .01, 4.: .012}
                    if condition == "contact" and mechanism not in FLAT:
                        bounds = {.2: .01}  # farther, what touches may gain in space
                    self.check(mechanism, condition, bounds)


if __name__ == "__main__":
    unittest.main()
