"""Solids that lie in contact in water stay at rest: one density of each case of tests/support/resting_cases.py; tools/measure-rest has them all."""
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from resting_cases import RESTING, raft, run, sliding  # noqa: E402


class RestingCases(unittest.TestCase):
    def test_rest(self):
        """Unequal stacks took six solves a phase while contact swept plainly."""
        for name, (case, ratios) in RESTING.items():
            for coupling in (None, "mixed face"):
                with self.subTest(name, coupling=coupling):
                    one = run(case, ratios[1], 2, .01, coupling=coupling)
                    self.assertLess(one["speed"], 1e-6)
                    self.assertLess(one["energy"], 1e-10)
                    self.assertLess(one["momentum"], 1e-14)
                    self.assertLess(one["solves"], 2.5)
                    self.assertEqual(one["outside"], 0)

    def test_a_raft_rests_in_volume_of_fluid(self):
        """A trace that the correction of the volume left above the surface became one of its own: the raft set off at 5 mm/s in the fifth step."""
        self.assertLess(run(raft, .25, 2, .01, coupling="mixed face", interface="volume of fluid")["speed"], 1e-6)

    def test_a_block_slides_beyond_the_limit_of_friction(self):
        """It holds at .99 of it."""
        self.assertGreater(run(sliding, 2., 2, .01)["speed"], 1e-4)


unittest.main()
