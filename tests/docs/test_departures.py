"""Defaults that docs/method.md names stand in docs/parameters with that value. Usage: test_departures.py ROOT

What xml-params/presets/paper.xml sets to another value than the default is named there, too.

The section "Where the defaults depart from the paper" writes them as `List/Parameter` = `value`; a list of a plug-in that many
may have, as "Solids/deformable body", is named by its type, and so is a coupling. `List/Type` is the plug-in that a scene has which names none.
"""
import re
import sys
import unittest
import xml.etree.ElementTree as ElementTree
from pathlib import Path

ROOT = Path(sys.argv.pop(1)).resolve() if len(sys.argv) > 1 else Path(__file__).resolve().parents[2]
PARAMETERS = ROOT / "docs/parameters"
SECTION = re.compile(r"^## Where the defaults depart from the paper\n(.*?)(?=^## )", re.MULTILINE | re.DOTALL)
NAMED = re.compile(r"`([A-Z][^`/]*(?:/[^`/]+)+)` = `([^`]*)`")


def cells(line):
    return [cell.strip() for cell in line.strip().strip("|").split(" | ")]


def parameters_of(page, prefix):
    """(path, default) of every parameter on a page."""
    place = prefix
    for line in page.read_text().splitlines():
        if line.startswith("## "):
            place = "/".join(part for part in (prefix, re.sub(r' \(Type ".*"\)$', "", line[3:])) if part)
        elif line.startswith("| ") and len(cells(line)) >= 6 and cells(line)[0] != "Name":
            name, _, default = cells(line)[:3]
            yield "/".join(part for part in (place, name) if part), re.sub(r" \(2D: .*\)$", "", default).strip('"')


def documented():
    """All that docs/parameters says, as sets of defaults by path: one plug-in may have another than the next."""
    found = {}
    for path, default in parameters_of(PARAMETERS / "scene.md", ""):
        found.setdefault(path, set()).add(default)
    listed = re.findall(r"^\| `([^`]+)` \| \[([^\]]+)\]\(([^)]+)\)( \(default\))?", (PARAMETERS / "README.md").read_text(), re.MULTILINE)
    for place, name, page, is_default in listed:
        if is_default:
            found.setdefault(f"{place}/Type", set()).add(name)
            prefix = place
        elif place in ("Solids", "Coupling"):
            prefix = f"{place}/{name}"
        else:
            continue  # one that a scene must ask for has no part in the defaults
        for path, default in parameters_of(PARAMETERS / page, prefix):
            found.setdefault(path, set()).add(default)
    return found


def leaves(element, place=()):
    """(names from the top, value) of every parameter in a list."""
    for child in element:
        name = child.get("name")
        if child.tag == "ParameterList":
            yield from leaves(child, (*place, name))
        else:
            yield (*place, name), child.get("value")


def of_the_paper():
    """(path as in this section, value) of what the preset "paper" says. The parts of a strategy are that strategy's, not defaults."""
    preset = list(leaves(ElementTree.parse(ROOT / "xml-params/presets/paper.xml").getroot()))
    types = {place[:-1]: value for place, value in preset if place[-1] == "Type"}
    for place, value in preset:
        if place[0] == "Defaults":
            place = ("Solids", *place[1:])
        elif place[0] == "Coupling" and place[-1] != "Type":
            place = ("Coupling", types[("Coupling",)], *place[1:])
        if place[:2] != ("Solver", "Strategy") or place[2:] == ("Type",):
            yield "/".join(place), value


class Departures(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.section = SECTION.search((ROOT / "docs/method.md").read_text()).group(1)
        cls.documented = documented()

    def test_defaults_are_those_of_the_parameters(self):
        named = NAMED.findall(self.section)
        self.assertGreater(len(named), 15)
        for path, value in named:
            with self.subTest(parameter=path):
                self.assertTrue(path in self.documented, "there is no such parameter")
                self.assertEqual({value}, self.documented[path])

    def test_what_the_preset_paper_sets_otherwise_is_named(self):
        named = {path for path, _ in NAMED.findall(self.section)}
        self.assertEqual([path for path, _ in of_the_paper() if path not in self.documented], [])
        departures = [path for path, value in of_the_paper() if self.documented[path] != {value}]
        self.assertGreater(len(departures), 6)
        for path in departures:
            # A parameter of all couplings is documented, and named, without one.
            other = "/".join(path.split("/")[:1] + path.split("/")[2:])
            with self.subTest(parameter=path):
                self.assertTrue({path, other} & named, "the section does not name it")

    def test_every_row_has_a_reason_and_a_figure(self):
        rows = [cells(line) for line in self.section.splitlines() if line.startswith("| ")][1:]
        self.assertGreater(len(rows), 20)
        for row in rows:
            with self.subTest(part=row[0]):
                self.assertEqual(len(row), 4)
                self.assertTrue(all(row))
                self.assertRegex(row[3], r"results/[\w-]+\.md|no page shows it")


if __name__ == "__main__":
    unittest.main()
