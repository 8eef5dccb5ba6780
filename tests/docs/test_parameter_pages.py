"""The pages of docs/parameters against what the program prints for people. Usage: test_parameter_pages.py SIMULATE

That they are current is what tools/update-parameters --check says; this is about what must be on them.
"""
import re
import subprocess
import sys
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SIMULATE = sys.argv.pop(1)
FOLDER = ROOT / "docs/parameters"
sys.path.insert(0, str(ROOT / "tools/reference_pages"))
import parameter_pages  # noqa: E402
import shipped_scenes  # noqa: E402

PREFIXES = {"fluid": "fluid", "solid": "solid", "coupling": "coupling", "contact model": "contact",
            "solver strategy": "strategy", "observer": "observer", "articulation": "articulation",
            "interface model": "interface", "joint": "joint"}
# Kinds whose names stand on the page of what they are part of.
PAGES = {"material": "solid-deformable-body", "target": "joint-hinge"}


def printed(*options):
    return subprocess.run([SIMULATE, *options], stdout=subprocess.PIPE, text=True, check=True).stdout


def page(name):
    return (FOLDER / f"{name}.md").read_text()


def parameter(documentation, kind="double", default="0", allowed=""):
    return {"name": "A", "type": kind, "default": default, "allowed": allowed, "documentation": documentation}


class Pages(unittest.TestCase):
    def test_every_plug_in_has_one(self):
        plug_ins = re.findall(r"^([a-z ]+): (.+)\n    (.+)$", printed("--list-plugins"), re.MULTILINE)
        self.assertGreater(len(plug_ins), 15)
        for kind, name, documentation in plug_ins:
            with self.subTest(kind=kind, name=name):
                if kind in PAGES:
                    self.assertIn(name, page(PAGES[kind]))
                    continue
                text = page(f"{PREFIXES[kind]}-{name.replace(' ', '-')}")
                self.assertIn(documentation.rstrip("."), text)
                self.assertRegex(text, "shipped scene|Scenes that use it")
                self.assertIn(f"[{name}]", page("README"))

    def test_every_parameter_is_on_one(self):
        written = {name for path in FOLDER.glob("*.md") for name in re.findall(r"^\| ([^|]+) \|", path.read_text(), re.MULTILINE)}
        for dimension in ("2", "3"):
            names = set(re.findall(r"^ +(\S.*?) : (?:int|double|bool|string|Array)", printed("--parameters", "--dimension", dimension),
                                   re.MULTILINE))
            self.assertGreater(len(names), 100)
            self.assertEqual(names - written - {"Type"}, set())

    def test_help_is_our_own(self):
        self.assertTrue(printed("--help").startswith("Runs a scene"), "or Kokkos answers before us")

    def test_the_right_page(self):
        self.assertIn("| Dry Points | Array(double) | unset | m |", page("fluid-mac"))
        self.assertIn("| Drops | string |", page("interface-particle-level-set"))
        self.assertNotIn("| Drops |", page("fluid-mac"))
        self.assertIn("| Stretch Limit | double | 0 | 1 | at least 0 |", page("solid-cloth"))


class Rows(unittest.TestCase):
    def row(self, *three, two=None):
        return parameter_pages.row_of(parameter(*three), parameter(*(two or three)))[1:]

    def test_units(self):
        self.assertEqual(self.row("Density [kg/m^3] (2D: [kg/m^2])."), ("double", "0", "kg/m^3 (2D: kg/m^2)", "", "Density."))
        self.assertEqual(self.row("Torque over turn [N m/rad, N/m]; 0: none."), ("double", "0", "N m/rad, N/m", "", "Torque over turn; 0: none."))
        self.assertEqual(self.row("Outside all \"Regions\", [1]."), ("double", "0", "1", "", "Outside all \"Regions\"."))
        self.assertEqual(self.row("A formula, value=\"[2*R]\" or \"{[R], 0}\"."), ("double", "0", "", "", "A formula, value=\"[2*R]\" or \"{[R], 0}\"."))

    def test_two_dimensions(self):
        row = self.row("Turn [rad].", "Array(double)", "{0, 0, 0}", "3 components", two=("Angle [rad].", "double", "0", ""))
        self.assertEqual(row, ("Array(double) (2D: double)", "{0, 0, 0} (2D: 0)", "rad", "3 components (2D: any)", "Turn. (2D: Angle.)"))
        sections = parameter_pages.sections_of(
            [{"path": "X", "documentation": "", "note": "", "parameters": [parameter("Three.")]}],
            [{"path": "X", "documentation": "", "note": "", "parameters": [parameter("Two.") | {"name": "B"}]},
             {"path": "Y", "documentation": "Plane.", "note": "", "parameters": []}])
        self.assertEqual([row[5] for row in sections[0].rows], ["3D: Three.", "2D: Two."])
        self.assertEqual(sections[1].documentation, "In 2D only. Plane.")

    def test_lists_like_one_before_are_named_only(self):
        rows = [("A", "double", "0", "m", "", "Length.")]
        others = [("A", "double", "1", "m", "", "Length.")]
        page_of = parameter_pages.Page("p", "P", [parameter_pages.Section("L/" + name, "Side.", "", kind)
                                                  for name, kind in (("one", rows), ("two", rows), ("three", others))])
        text = parameter_pages.body(page_of)
        self.assertIn("## L/two\n\nAs [L/one](#lone).", text)
        self.assertEqual(text.count("| A |"), 2)


class Scenes(unittest.TestCase):
    """Contents of the files, read without their structure."""

    DEFAULTS = {"Fluid": "mac", "Coupling": "mixed face", "Contact": "gauss seidel", "Solver/Strategy": "schur-cg",
                "Free Surface/Interface": "particle level set", "Articulation": "reduced coordinates",
                "Solids": None, "Joints": None, "Observers": None}

    def test_use(self):
        found, scenes = shipped_scenes.uses(self.DEFAULTS)
        self.assertGreater(len(scenes), 25)
        texts = {scene: scene.read_text() for scene in scenes}

        def with_type(name):
            return [scene for scene in scenes if f'name="Type" type="string" value="{name}"' in texts[scene]]
        self.assertEqual(found["Solids", "cloth"][0], with_type("cloth"))
        self.assertEqual(found["Joints", "hinge"][0], with_type("hinge"))
        self.assertEqual(found["Coupling", "flux"][0], with_type("flux"))
        self.assertEqual(found["Coupling", "mixed face"][0], [scene for scene in scenes if scene not in with_type("flux")])
        self.assertEqual(found["Free Surface/Interface", "particle level set"][0],
                         [scene for scene in scenes if '"Free Surface"' in texts[scene]
                          and scene not in with_type("level set") + with_type("volume of fluid")])
        studies = [path.name for path in found["Solver/Strategy", "paper"][1]]
        self.assertIn("density-ratio.xml", studies)

    def test_what_is_included_counts(self):
        both = shipped_scenes.merged({"Fluid": {"Type": "mac", "Density": "1"}, "Title": "a"}, {"Fluid": {"Density": "2"}, "Title": "b"})
        self.assertEqual(both, {"Fluid": {"Type": "mac", "Density": "2"}, "Title": "b"})

    def test_settings_of_studies(self):
        text = 'value="Coupling/Type=flux; Solver/Strategy/Type=paper" value="Fluid/Free Surface/Interface/Type=level set" value="Solids/Bag/Membrane/Type=mass-spring"'
        self.assertEqual(shipped_scenes.assigned_types(text, self.DEFAULTS),
                         {("Coupling", "flux"), ("Solver/Strategy", "paper"), ("Free Surface/Interface", "level set")})


if __name__ == "__main__":
    unittest.main()
