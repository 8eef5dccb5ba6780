"""The bounds of the studies' tests catch wrong results; every study has such a test."""
import math
import re
import unittest
import xml.etree.ElementTree
from pathlib import Path

from check_study import check, measured, rows_of, selected

HERE = Path(__file__).resolve().parent
TESTS = re.compile(r"^lockstep_verification\(([\w-]+)(.*?)\)$", re.MULTILINE | re.DOTALL)
ROUND_OFF = 1e-3  # bounds below are those of solves and round-off: powers of ten
LOOSE = 1.5  # a bound may be so many times the figure of its page
# Bounds that are not near the figure of their page, each with its reason in CMakeLists.txt.
FAR_FROM_THE_PAGE = {
    ("water-volume", "worst step"), ("water-volume", "share of steps.*"), ("drops", "drops. most"), ("fsi1", "(drag|lift)"),
    ("inversion", "clamped elements. most"), ("dam-break-box", "height H4.*")}


def tests():
    """(study, rungs or None, SERIES or "", expectations) of each lockstep_verification."""
    for study, text in TESTS.findall((HERE / "CMakeLists.txt").read_text()):
        rungs, series = re.search(r"RUNGS (\d+):(\d+)", text), re.search(r'SERIES "([^"]*)"', text)
        yield (study, rungs and tuple(map(int, rungs.groups())), series[1] if series else "",
               [[part.strip() for part in one.split(" | ")] for one in re.findall(r'"([^"]*)"', text.split("EXPECT", 1)[1])])


def rows_of_page(study, rungs, series):
    """The rows of docs/results that a test would measure, in the order of the ladder."""
    page = HERE.parents[1] / f"docs/results/{study}.csv"
    seen = {}
    for row in rows_of(page) if page.exists() else ():
        name = row["series"].replace(";", ",")
        if not series or re.fullmatch(series, name):
            seen.setdefault((name, row["quantity"]), []).append(row)
    first, last = rungs or (1, None)
    return [row for ladder in seen.values() for row in ladder[first - 1:last]]


def figure(rows, expectation):
    """The number of the page that a bound is nearest to; None if there is none."""
    series, quantity, column, which, relation, _ = expectation
    matched = selected(rows, series, quantity)
    if which == "last":
        matched = list({row["series"]: row for row in matched}.values())
    values = [value for value in (measured(row, column) for row in matched if row[column] != "") if math.isfinite(value)]
    if not values:
        return None
    if which == "spread":
        return max(values) - min(values)
    return max(values) if relation.startswith("<") else min(values)


def row(**columns):
    return {"series": "a", "quantity": "drag", "h": "0.1", "value": "1", "error": "0.1", "order": "", **columns}


class Expectations(unittest.TestCase):
    def holds(self, expectation, *rows):
        return check([row(**columns) for columns in rows], expectation) == []

    def test_an_order_has_a_sign(self):
        self.assertTrue(self.holds("a | drag | order | all | > | 1.9", {}, {"order": "2"}))
        self.assertFalse(self.holds("a | drag | order | all | > | 1.9", {}, {"order": "-2"}))

    def test_values_and_errors_are_compared_by_size(self):
        self.assertFalse(self.holds("a | drag | error | all | < | 0.01", {"error": "-0.1"}))
        self.assertFalse(self.holds("a | drag | value | all | < | 0.01", {"value": "-0.1"}))

    def test_what_is_not_finite_holds_to_no_bound(self):
        for relation in "<", ">":
            for value in "nan", "inf", "-inf":
                self.assertFalse(self.holds(f"a | drag | value | all | {relation} | 0.5", {"value": value}))
        self.assertFalse(self.holds("a | drag | value | spread | < | 1e9", {}, {"value": "nan"}, {}))
        self.assertFalse(self.holds("a | drag | value | spread | < | 1e9", {"value": "nan"}))

    def test_what_matches_nothing_holds_not(self):
        self.assertFalse(self.holds("b | drag | value | all | < | 9", {}))
        self.assertFalse(self.holds("a | drag | order | all | > | 1", {}))
        self.assertTrue(self.holds("a | drag | value | last | < | 2", {"value": "9"}, {}))


class Tests(unittest.TestCase):
    def test_every_study_has_one(self):
        tested = re.findall(r"^lockstep_verification\(([\w-]+)", (HERE / "CMakeLists.txt").read_text(), re.MULTILINE)
        files = sorted((HERE.parents[1] / "xml-params/studies").glob("*.xml"))
        studies = [file.stem for file in files if xml.etree.ElementTree.parse(file).getroot().get("name") == "Study"]
        self.assertGreater(len(studies), 70)
        self.assertEqual(sorted(set(studies) - set(tested)), [], "add a lockstep_verification(...) at their first rungs")
        self.assertEqual(sorted(set(tested) - set(studies)), [])

    def test_bounds_are_near_the_figures_of_the_pages(self):
        n_bounds, far = 0, set()
        for study, rungs, series, expectations in tests():
            rows = rows_of_page(study, rungs, series)
            for expectation in expectations:
                bound, found = float(expectation[5]), figure(rows, expectation)
                if bound < ROUND_OFF or expectation[2] == "order" or not found:
                    continue
                n_bounds += 1
                if (study, expectation[1]) in FAR_FROM_THE_PAGE:
                    far.add((study, expectation[1]))
                    continue
                with self.subTest(study=study, expectation=" | ".join(expectation)):
                    self.assertLess(max(bound / found, found / bound), LOOSE, f"the page has {found:.3g}")
        self.assertGreater(n_bounds, 100)
        self.assertEqual(FAR_FROM_THE_PAGE - far, set())


if __name__ == "__main__":
    unittest.main()
