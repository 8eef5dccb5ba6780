"""Tables of docs/results hold what their tests ask of the same study. Usage: test_result_bounds.py ROOT

Every bound of a lockstep_verification(...) in tests/verification/CMakeLists.txt is asked of the study's published table: of the
rungs that the test runs, and bounds from above of errors and values of finer grids, too. A page that breaks one is older than
the code, or the test is wrong. known_bounds.txt names the exceptions with their reasons, and has to be rid of those that are none
any more.
"""
import re
import sys
import unittest
from pathlib import Path

ROOT = Path(sys.argv.pop(1)).resolve() if len(sys.argv) > 1 else Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests/verification")]
import check_study  # noqa: E402

CALL = re.compile(r"^lockstep_verification\((\S+)(.*?)\)\n(?=\n|\w|#|\Z)", re.MULTILINE | re.DOTALL)
EVERY_RUNG = "1:1000"


def asked(text):
    """(study, rungs, series, expectation) of every bound in the text of a CMakeLists.txt."""
    for study, arguments in CALL.findall(text):
        option = {key: value.strip('"') for key, value in re.findall(r"(RUNGS|SERIES) (\"[^\"]*\"|\S+)", arguments)}
        expectations = re.findall(r'"([^"]*(?: \| [^"]*){5})"', arguments)
        for expectation in expectations:
            yield study, option.get("RUNGS", EVERY_RUNG), option.get("SERIES", ".*"), expectation


def on_rungs(rows, first, last):
    """The rows of these rungs, counted from 1 in every series of a quantity."""
    seen, chosen = {}, []
    for row in rows:
        name = row["series"], row["quantity"]
        seen[name] = seen.get(name, 0) + 1
        if first <= seen[name] <= last:
            chosen.append(row)
    return chosen


def failures(rows, rungs, series, expectation):
    """Rows of a table that break the bound of a test which runs these rungs of these series, a line each."""
    begin, end = (int(part) for part in rungs.split(":"))
    rows = [row for row in rows if re.fullmatch(series, row["series"].replace(";", ","))]
    found = check_study.check(on_rungs(rows, begin, end), expectation)
    _, _, column, which, relation, _ = expectation.split(" | ")
    if relation.startswith("<") and which != "spread" and column != "order":
        most = max((float(row["cells"]) for row in on_rungs(rows, begin, end)), default=0)
        finer = [row for row in on_rungs(rows, end + 1, sys.maxsize) if float(row["cells"]) > most]
        found += [line for line in check_study.check(finer, expectation) if not line.startswith("no ")]
    return found


def known_bounds(file):
    """(study, expectation): the reason."""
    lines = (line for line in file.read_text().splitlines() if line and not line.startswith("#"))
    return {tuple(part.strip() for part in line.split(" :: ")[:2]): line.split(" :: ")[2] for line in lines}


class Bounds(unittest.TestCase):
    def test_pages_hold_the_bounds_of_their_tests(self):
        known, broken, n_bounds = known_bounds(ROOT / "tests/docs/known_bounds.txt"), set(), 0
        for study, rungs, series, expectation in asked((ROOT / "tests/verification/CMakeLists.txt").read_text()):
            table = ROOT / f"docs/results/{study}.csv"
            if not table.exists():
                continue
            n_bounds += 1
            if found := failures(check_study.rows_of(table), rungs, series, expectation):
                broken.add((study, expectation))
                with self.subTest(study=study, bound=expectation):
                    self.assertTrue((study, expectation) in known, found)
        self.assertGreater(n_bounds, 300)
        for name in known.keys() - broken:
            with self.subTest(bound=name):
                self.fail("known_bounds.txt need not name it any more")


class Rule(unittest.TestCase):
    ROWS = [{"series": "a", "quantity": "q", "h": "1", "cells": str(number), "error": error}
            for number, error in enumerate(("0.4", "0.1", "0.02", "0.3"))]

    def failures(self, rungs, expectation):
        return failures(self.ROWS, rungs, ".*", expectation)

    def test_finer_grids_hold_bounds_from_above(self):
        self.assertTrue(self.failures("1:2", "a | q | error | last | < | 0.2"))
        self.assertFalse(self.failures("1:2", "a | q | error | last | < | 0.35"))

    def test_other_rungs_of_one_grid_need_not(self):
        rows = [{**row, "cells": "9"} for row in self.ROWS]
        self.assertFalse(failures(rows, "1:2", ".*", "a | q | error | last | < | 0.2"))

    def test_coarser_rungs_are_not_asked(self):
        self.assertFalse(self.failures("2:3", "a | q | error | all | < | 0.35"))

    def test_bounds_from_below_are_those_of_the_rungs_that_run(self):
        self.assertFalse(self.failures("1:2", "a | q | error | all | > | 0.05"))
        self.assertTrue(self.failures("1:3", "a | q | error | all | > | 0.05"))

    def test_a_bound_that_matches_nothing_is_broken(self):
        self.assertTrue(self.failures("1:2", "b | q | error | all | < | 1"))

    def test_calls_are_read(self):
        text = 'lockstep_verification(one RUNGS 1:2 SERIES "a (b)"\n  EXPECT "x | y | error | all | < | 1"\n         "x | z | value | last | > | 2")\n'
        self.assertEqual([entry[0] + entry[1] + entry[2] for entry in asked(text)], ["one1:2a (b)"] * 2)


if __name__ == "__main__":
    unittest.main()
