"""The part of a wave that comes back from the beach of the shipped flume, and how fast fluid slows down where it is damped."""
import math
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from scene_xml import xml  # noqa: E402
from simulation import attempt, column, simulate, table  # noqa: E402

ROOT = Path(__file__).resolve().parents[2]
FREQUENCY = 1.2472


class WaveFlume(unittest.TestCase):
    def test_less_than_two_parts_in_a_hundred_come_back(self):
        with tempfile.TemporaryDirectory() as folder:
            output = Path(folder) / "output"
            simulate(ROOT / "xml-params/scenes/wave-flume.xml", output, "--set", "Output/Frames=false", seconds=900)
            heights = [self.amplitude(table(output / f"Gauge {i}.csv")) for i in range(1, 10)]
        back = (max(heights) - min(heights)) / (max(heights) + min(heights))
        print(f"amplitude {sum(heights) / 9:.5f} m, reflection {100 * back:.2f} %")
        self.assertLess(back, .02)
        self.assertAlmostEqual(sum(heights) / 9, .01, delta=6e-4)

    @staticmethod
    def amplitude(rows):
        """The amplitude at the wave's frequency, in the last five periods."""
        times, tops = column(rows, "time"), column(rows, "top")
        begin = times[-1] - 5 / FREQUENCY
        last = [(t, top) for t, top in zip(times, tops) if t > begin]
        mean = sum(top for _, top in last) / len(last)
        parts = [sum((top - mean) * f(2 * math.pi * FREQUENCY * t) for t, top in last) for f in (math.cos, math.sin)]
        return 2 * math.hypot(*parts) / len(last)

    def run_box(self, dimension, fluid, sides, steps=10):
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "scene.xml"
            file.write_text(xml("Scene", {
                "Dimension": dimension, "Domain": {"Cells": (8,) * dimension, "Sides": sides}, "Fluid": {"Density": 1., **fluid},
                "Solver": {"Tolerance": 1e-12}, "Time": {"End": 100., "Fixed Step": .05}, "Output": {"Frames": False}}))
            result = attempt(file, Path(folder) / "output", "--steps", steps)
            rows = table(Path(folder) / "output/history.csv") if result.returncode == 0 else []
            return result, rows

    def test_damping_is_of_its_rate(self):
        for dimension in (2, 3):
            with self.subTest(dimension=dimension):
                sides = {f"{a} {end}": {"Type": "periodic"} for a in "xyz"[:dimension] for end in ("lower", "upper")}
                velocity = (1.,) + (0.,) * (dimension - 1)
                _, rows = self.run_box(dimension, {"Velocity": velocity, "Damping": 2., "Order in Time": 1}, sides)
                self.assertAlmostEqual(column(rows, "fluid_momentum_x")[-1], 1.1 ** -10, delta=1e-12)
                self.assertLess(max(column(rows, "momentum_error")), 1e-10)

    def test_still_water_rests_on_a_beach(self):
        for dimension in (2, 3):
            with self.subTest(dimension=dimension):
                pool = {"Liquid": {"Pool": {"Type": "level", "Height": .53}}}
                fluid = {"Gravity": (0.,) * (dimension - 1) + (-10.,), "Damping": "50*x^2", "Free Surface": pool}
                _, rows = self.run_box(dimension, fluid, {})
                self.assertLess(max(column(rows, "fluid_kinetic_energy")), 1e-14)

    def test_negative_rates_are_refused(self):
        result, _ = self.run_box(2, {"Damping": "x - 0.5"}, {})
        self.assertEqual(result.returncode, 2)
        self.assertIn('"Damping" is -0.375 1/s at x = 0.125', result.stdout)


if __name__ == "__main__":
    unittest.main()
