"""The bounds of the studies' tests catch wrong results; every study has such a test."""
import re
import unittest
import xml.etree.ElementTree
from pathlib import Path

from check_study import check

HERE = Path(__file__).resolve().parent


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


if __name__ == "__main__":
    unittest.main()
