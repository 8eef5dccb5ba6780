"""Parameters: each is used by a shipped file or a test, and there are no more than the house wants. Usage: test_parameters.py ROOT

The names are those of docs/parameters, which the test docs.parameters holds against the programs.
"""
import re
import sys
import unittest
from pathlib import Path

ROOT = Path(sys.argv.pop(1)).resolve() if len(sys.argv) > 1 else Path(__file__).resolve().parents[2]

# 140 were reached on 2026-11-26, from 199; masses and lines that users asked for are 5 more, two phases 1, libraries of plug-ins 1. Who adds a name takes another away, merges two that say the same, or makes one a constant.
MOST_NAMES = 148
ROW = re.compile(r"^\| ([^|]+) \| (?:int|double|bool|string|Array)", re.MULTILINE)


def names_of(page):
    """Names of the parameters in the tables of a page; of every list, "Type" chooses the others."""
    return set(ROW.findall(page)) - {"Type"}


def is_used(name, text):
    """True if a file gives a parameter of this name a value: in XML, as "List/Name=value", or as a quoted name."""
    quoted = re.escape(name)
    return bool(re.search(rf"""["']{quoted}\\?["']|/{quoted}(?:\[\d\])?=""", text))


def texts():
    """All shipped scenes, studies, presets and solver lists, and all tests but this one."""
    files = [*(ROOT / "xml-params").rglob("*.xml")]
    files += [path for suffix in ("*.py", "*.cpp", "*.hpp", "*.xml") for path in (ROOT / "tests").rglob(suffix)]
    return [path.read_text() for path in files if path != Path(__file__).resolve()]


class Parameters(unittest.TestCase):
    def setUp(self):
        pages = [path for path in (ROOT / "docs/parameters").glob("*.md") if path.name != "README.md"]
        self.names = set().union(*(names_of(path.read_text()) for path in pages))

    def test_each_is_used_by_a_shipped_file_or_a_test(self):
        everything = texts()
        unused = sorted(name for name in self.names if not any(is_used(name, text) for text in everything))
        self.assertEqual(unused, [], "no scene, study, preset, solver list or test uses these: take them away, or use them")

    def test_there_are_few(self):
        self.assertLessEqual(len(self.names), MOST_NAMES, ", ".join(sorted(self.names)))

    def test_a_former_name_is_none_of_today(self):
        table = (ROOT / "src/parameters/former_names.cpp").read_text()
        everywhere = set(re.findall(r'\{"", "([^"]+)",', table))
        self.assertGreater(len(everywhere), 5)
        self.assertEqual(everywhere & self.names, set(), "name the list that had it")

    def test_a_former_column_is_called_what_a_table_has(self):
        former = re.findall(r'\{"history.csv", "(\w+)",\s*"is called \\"(\w+)\\"', (ROOT / "src/parameters/former_names.cpp").read_text())
        columns = (ROOT / "src/stepping/report/run_columns.cpp").read_text()
        self.assertGreater(len(former), 3)
        for names in former:
            old, new = ('"' + re.sub("_[xyz]$", "_", name) + '"' for name in names)
            self.assertNotIn(old, columns)
            self.assertIn(new, columns)

    def test_what_counts_as_use(self):
        for text, used in (('<Parameter name="Soft Spot" type="int" value="1"/>', True), ('list.set("Soft Spot", 1);', True),
                           ("Solids/A/Soft Spot=3", True), ("Solids/A/Soft Spot[1]=3", True), ("a Soft Spot", False),
                           ('"Soft Spots"', False), (r'"{\"Soft Spot\": 1}"', True)):
            self.assertEqual(is_used("Soft Spot", text), used, text)
        self.assertEqual(names_of("| Name | Type |\n|---|---|\n| Soft Spot | int | 1 |\n| Type | string | |\n"), {"Soft Spot"})


if __name__ == "__main__":
    unittest.main()
