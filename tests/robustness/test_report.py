#!/usr/bin/python3
"""The page of results can be written of scenes of every family, and each of its rows is drawn by one of them."""
import tempfile
import unittest
from pathlib import Path

import report
from random_scenes import Result

SEEDS = [first + k for first in report.FAMILIES.values() for k in range(40)]


class Page(unittest.TestCase):
    def test_every_row_is_drawn(self):
        with tempfile.TemporaryDirectory() as folder:
            page = Path(folder) / "page.md"
            report.write_scenes(page, SEEDS, [Result(seed, ["restart: parts"] * (seed == 3), 0, 1.0, "a build") for seed in SEEDS], True)
            text = page.read_text()
        self.assertIn("400 scenes", text)
        self.assertIn("- seed 3: not known before", text)
        for name in report.FEATURES:
            row = next(line for line in text.splitlines() if line.startswith(f"| {name} |"))
            self.assertRegex(row, r"\d", f"no seed of these draws it: {row}")

    def test_seams(self):
        with tempfile.TemporaryDirectory() as folder:
            page = Path(folder) / "page.md"
            report.write_seams(page, [7000, 7001], [Result(7000, [], 0, 1.0, "a build"), Result(7001, ["ranks: hangs"], 1, 1.0, "a build")],
                               [1, 2, 3, 4])
            text = page.read_text()
        self.assertIn("seeds 7000-7001, each on 1, 2, 3 and 4 ranks: 1 fail", text)
        self.assertIn("- seed 7001: ranks: hangs", text)


if __name__ == "__main__":
    unittest.main()
