"""On the finest grid of a series of docs/results the error is the least, or it is known why not. Usage: test_result_series.py ROOT

Looks at every quantity with an error, of every series with three rungs or more whose cells become more from rung to rung: the
error of the last rung may not be above that of the one before it, nor above that of the first. Errors below 1e-10 are round-off.
known_series.txt names the exceptions, and has to be rid of those that are none any more.
"""
import csv
import sys
import unittest
from pathlib import Path

ROOT = Path(sys.argv.pop(1)).resolve() if len(sys.argv) > 1 else Path(__file__).resolve().parents[2]
ROUND_OFF = 1e-10


def table_of(page):
    lines = (line for line in page.read_text().splitlines() if not line.startswith("#"))
    return list(csv.DictReader(lines))


def series_of(rows):
    """(quantity, series): its rows, the coarsest first."""
    found = {}
    for row in rows:
        found.setdefault((row["quantity"], row["series"]), []).append(row)
    return found


def is_resolution(rows):
    cells = [float(row["cells"]) for row in rows]
    return len(rows) >= 3 and all(before < after for before, after in zip(cells, cells[1:]))


def rises(rows):
    """True if the last step raises the error; with "self" as reference the finest rung has none, and the one before it counts."""
    errors = [float(row["error"]) for row in rows if row["error"]]
    return len(errors) >= 2 and not (errors[-1] < ROUND_OFF or errors[-1] <= min(errors[-2], errors[0]))


def rising_series(root):
    """(page, quantity, series): its errors."""
    found = {}
    for page in sorted((root / "docs/results").glob("*.csv")):
        rows = table_of(page)
        if rows and {"quantity", "series", "cells", "error"} <= rows[0].keys():
            found.update({(page.stem, *name): [row["error"] for row in one] for name, one in series_of(rows).items()
                          if is_resolution(one) and rises(one)})
    return found


def known_series(file):
    """(page, quantity, series): the reason."""
    known = {}
    for line in file.read_text().splitlines():
        if line and not line.startswith("#"):
            page, quantity, series, reason = [part.strip() for part in line.split(" | ")]
            known.update({(page, quantity, one.strip()): reason for one in series.split(" / ")})
    return known


class Series(unittest.TestCase):
    def test_the_finest_grid_is_the_best_or_it_is_known_why_not(self):
        rising, known = rising_series(ROOT), known_series(ROOT / "tests/docs/known_series.txt")
        for name, errors in rising.items():
            with self.subTest(series=" | ".join(name)):
                self.assertTrue(name in known, f"errors {', '.join(errors)}: find out why, and say it in known_series.txt")
        for name in known.keys() - rising.keys():
            with self.subTest(series=" | ".join(name)):
                self.fail("known_series.txt need not name it any more")

    def test_every_exception_has_a_reason(self):
        for name, reason in known_series(ROOT / "tests/docs/known_series.txt").items():
            self.assertGreater(len(reason), 10, name)


class Rule(unittest.TestCase):
    def rises(self, *errors):
        return rises([{"error": str(error)} for error in errors])

    def test_the_last_step(self):
        self.assertFalse(self.rises(0.3, 0.1, 0.02))
        self.assertFalse(self.rises(0.3, 0.4, 0.02))
        self.assertTrue(self.rises(0.3, 0.1, 0.11))
        self.assertTrue(self.rises(0.3, 0.5, 0.4))   # less than before, more than on the coarsest grid
        self.assertTrue(self.rises(0.3, 0.1, "nan"))

    def test_what_does_not_count(self):
        self.assertFalse(self.rises(1e-13, 1e-12, 1e-11))
        self.assertFalse(self.rises(0.3, 0.1, ""))   # compared with the finest itself

    def test_ladders(self):
        def ladder(*cells):
            return is_resolution([{"cells": str(n)} for n in cells])
        self.assertTrue(ladder(16, 64, 256))
        self.assertFalse(ladder(16, 64))
        self.assertFalse(ladder(64, 64, 64))


if __name__ == "__main__":
    unittest.main()
