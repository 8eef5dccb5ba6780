"""The comparison of runs finds a nan in any row, where `max` and `>` would miss it."""
import math
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from compare_ranks import differences  # noqa: E402
from simulation import assert_close  # noqa: E402


def rows(*values):
    return [{"x": str(value)} for value in values]


class Comparison(unittest.TestCase):
    def test_ranks(self):
        self.assertEqual(differences(rows(1, 2), rows(1, 2.5)), {"x": 0.25})
        self.assertEqual(differences(rows(0, 0), rows(0, 0)), {"x": 0})
        self.assertEqual(differences(rows(0, 0), rows(0, 1)), {"x": math.inf})
        for other in (rows("nan", 2), rows(1, "nan")):
            self.assertTrue(math.isnan(differences(rows(1, 2), other)["x"]))
            self.assertTrue(math.isnan(differences(other, other)["x"]))

    def test_tables(self):
        good = rows(1, 2)
        assert_close(good, rows(1, 2.5), ["x"], 0.25)
        for other in (rows(1, 2.7), rows("nan", 2), rows(1, "nan"), rows(1, "inf")):
            for pair in ((good, other), (other, good)):
                with self.assertRaises(AssertionError):
                    assert_close(*pair, ["x"], 0.25)


if __name__ == "__main__":
    unittest.main()
