"""Phenomena of the paper's figures that coarse grids do not show: the shipped scenes with their own cells, in minutes."""
import unittest

from test_figures import Run


class Balloon(unittest.TestCase):
    """Fig. 12."""

    def test_leaves_through_the_top(self):
        """All of it: its centre comes a radius above the open top of the box, and slows down to there without a jump."""
        top, radius = 1.5, .15
        run = Run("balloon", (32, 48, 32), end=1.7)
        height, speed = run.of("Balloon", "y"), run.of("Balloon", "vy")
        self.assertGreater(height.max(), top + radius)
        passing = (run.times > 1.02) & (height > top - .25) & (height < top + radius)
        change = abs(speed[1:] - speed[:-1])[passing[1:] & passing[:-1]]
        self.assertLess(change.max(), .2 * speed.max())


if __name__ == "__main__":
    unittest.main()
