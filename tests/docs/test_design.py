"""docs/design.md says what the code says. Usage: test_design.py ROOT

- the path from the scene file to a frame: the file above an arrow names what the file behind it defines, every file is
  reached by an arrow before it is opened, and there are no more files than one reads in an hour
- the floors of src and the siblings of packages are those that check_layout allows, and no room is missing
- the table of plug-ins: folders, interfaces, functions that register and tutorials exist; what a new package registers
  by them is called in the list of all plug-ins
- sides stand in the files that are named, and the framework knows of no others
"""
import re
import sys
import unittest

from test_docs import ROOT, defines

sys.path.insert(0, str(ROOT / "tests/house"))
from check_layout import FLOORS, SIBLINGS, rooms  # noqa: E402

PAGE = (ROOT / "docs/design.md").read_text()
MOST_FILES = 43  # three of them are the frame of two schemes of time and of programs that load plug-ins
ARROW = re.compile(r" +(\S.*?) +-> (\S+): (\w+)$")
SHIPPED = ROOT / "packages/shipped/shipped_plug_ins.cpp"
SIDE = re.compile(r"\b(?:side_of|side)<(?:const )?(\w+)(?:<dim>)?>\(|virtual (?:const )?(\w+)<dim>\* \w+\(\)(?: const)? \{ return nullptr; \}")


def section(title):
    return PAGE.split(f"\n## {title}\n", 1)[1].split("\n## ", 1)[0]


def rows(title, n_columns):
    """Cells of the table rows of a section that has so many columns, without the header."""
    lines = [line for line in section(title).splitlines() if line.startswith("| ") and line.count("|") == n_columns + 1]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in lines[1:]]


def quoted(text):
    return re.findall(r"`([^`]+)`", text)


def arrows(path):
    """(file above, what passes, file behind, name) of each arrow of the text of a path."""
    above = None
    for line in path.strip().splitlines():
        match = ARROW.match(line)
        if match:
            yield above, *match.groups()
        else:
            above = line


def broken(found, root):
    """Sentences about arrows that the code does not have."""
    reached, opened = {found[0][0]}, []
    for above, _, behind, name in found:
        if above not in opened:
            opened.append(above)
            if above not in reached:
                yield f"{above} is opened, but no arrow leads there before"
        if not all((root / file).is_file() for file in (above, behind)):
            yield f"{above} -> {behind}: there is no such file"
            continue
        if not re.search(rf"\b{name}\b", (root / above).read_text()):
            yield f"{above} does not mention {name}"
        if not defines(root / behind, name):
            yield f"{behind} does not define {name}"
        reached.add(behind)


class Design(unittest.TestCase):
    def setUp(self):
        path = re.search(r"```text\n(.*?)```", section("From the scene file to a frame"), re.DOTALL).group(1)
        self.arrows = list(arrows(path))
        self.files = {file for above, _, behind, _ in self.arrows for file in (above, behind)}
        self.headings = [line for line in path.splitlines() if not line.startswith(" ")]

    def test_the_path_is_that_of_the_code(self):
        self.assertEqual(list(broken(self.arrows, ROOT)), [])

    def test_the_path_is_short_and_whole(self):
        self.assertLessEqual(len(self.files), MOST_FILES)
        self.assertEqual(len(self.headings), len(set(self.headings)), "a file is opened twice")
        self.assertEqual(self.arrows[0][0], "drivers/simulate.cpp")
        self.assertIn("src/output/frames.cpp", self.files)
        self.assertLessEqual(max(len(what) for _, what, _, _ in self.arrows), 40)

    def test_a_wrong_arrow_is_seen(self):
        for wrong in (("drivers/simulate.cpp", "", "src/parameters/files/strict_xml.cpp", "expand_scene"),   # defined elsewhere
                      ("src/output/frames.cpp", "", "src/parameters/files/parameter_file.cpp", "read_parameters"),      # not mentioned, not reached
                      ("drivers/simulate.cpp", "", "src/parameters/gone.cpp", "read_parameters")):
            self.assertTrue(list(broken([self.arrows[0], wrong], ROOT)), wrong)

    def test_rooms_and_floors(self):
        order = [quoted(row[0])[0].split("/")[1] for row in rows("Floors and rooms", 2)]
        self.assertEqual(sorted(order), sorted(rooms(ROOT, "src")))
        height = {room: number for number, floor in enumerate(FLOORS) for room in floor}
        self.assertEqual([height[room] for room in order], sorted(height.values()))
        siblings = {}
        for folders, _, knows in rows("Floors and rooms", 3):
            for folder in quoted(folders):
                siblings[folder.split("/")[1]] = set(quoted(knows))
        self.assertEqual(set(siblings), rooms(ROOT, "packages"))
        self.assertEqual({name: known for name, known in siblings.items() if known}, SIBLINGS)

    def test_collaborators_of_the_step(self):
        script = (ROOT / "src/stepping/step/time_scheme.hpp").read_text()
        members = set(re.findall(r"^  (\w+)<dim> \w*[a-z];", script, re.MULTILINE)) - {"CoupledSystem"}
        named = rows("A step", 4)
        self.assertEqual({quoted(row[0])[0] for row in named}, members)
        headers = "".join(file.read_text() for file in (ROOT / "src/stepping").rglob("*.hpp"))
        for *_, returned in named:
            for name in quoted(returned):
                self.assertRegex(headers, rf"struct {name}\b")

    def test_where_things_go(self):
        table = rows("Where does it go?", 5)
        self.assertGreater(len(table), 20)
        for what, folder, interface, registered, tutorial in table:
            with self.subTest(what):
                for path in quoted(folder + interface + registered):
                    file, _, name = path.partition(": ")
                    self.assertTrue((ROOT / file).exists(), file)
                    self.assertTrue(not name or defines(ROOT / file, name), f"{file} does not define {name}")
                    if name.startswith("register_") and file.startswith("packages/"):
                        self.assertIn(name, SHIPPED.read_text())
                self.assertRegex(tutorial, r"\]\([\w/.-]+\.md")

    def test_every_registration_has_a_row(self):
        registered = set(re.findall(r"\b(register_\w+)(?:<dim>)?\(", SHIPPED.read_text()))
        self.assertEqual(registered - set(re.findall(r": (register_\w+)`", section("Where does it go?"))),
                         {"register_deformable", "register_mixed_face"}, "two of a kind: one stands as the example")

    def test_sides(self):
        named = set()
        for sides, files, _ in rows("Plug-ins", 3):
            text = "".join((ROOT / "src/interfaces" / file).read_text() for file in quoted(files))
            for side in quoted(sides):
                self.assertRegex(text, rf"class {side}\b")
                named.add(side)
        asked = set()
        for file in [*(ROOT / "src").rglob("*.?pp"), *(ROOT / "drivers").rglob("*.?pp")]:
            asked |= {name for match in SIDE.findall(file.read_text()) for name in match if name}
        self.assertEqual(asked - {"Side"}, named)


if __name__ == "__main__":
    unittest.main()
