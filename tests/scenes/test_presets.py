"""The presets are valid with every scene that they are meant for, before the scene as after it, and each of their lines says why."""
import re
import sys
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests/support"), str(Path(__file__).parent)]
from run_scene import coarse_cells  # noqa: E402
from simulation import attempt, simulate  # noqa: E402

PRESETS = ROOT / "xml-params/presets"
SCENES = sorted((ROOT / "xml-params/scenes").glob("*.xml"))
BAD_INPUT = 2


def has_water(scene):
    return ElementTree.parse(scene).getroot().find("ParameterList[@name='Fluid']/ParameterList[@name='Free Surface']") is not None


MEANT_FOR = {
    "paper": SCENES,
    "accurate": [scene for scene in SCENES if not has_water(scene)],
    "accurate-water": [scene for scene in SCENES if has_water(scene)],
    "fast": SCENES,
}


class Presets(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def both(self, first, second, more=""):
        """A scene that says something itself, then what the first file says, then what the second does."""
        path = Path(self.folder.name) / "both.xml"
        path.write_text(f'<ParameterList name="Scene"><Parameter name="Include" type="Array(string)" value="{{{first}, {second}}}"/>{more}</ParameterList>')
        return path

    def validate(self, first, second, scene):
        cells = ", ".join(map(str, coarse_cells(scene)))
        return attempt(self.both(first, second), Path(self.folder.name) / "run", "--validate", "--set", f"Domain/Cells={{{cells}}}")

    def test_all_are_tested(self):
        self.assertEqual(sorted(MEANT_FOR), sorted(file.stem for file in PRESETS.glob("*.xml")))

    def test_valid_with_every_scene(self):
        for preset, scenes in MEANT_FOR.items():
            for scene in scenes:
                with self.subTest(preset=preset, scene=scene.stem):
                    result = self.validate(PRESETS / f"{preset}.xml", scene, scene)
                    self.assertEqual(result.returncode, 0, result.stdout)

    def test_second_order_and_water_are_refused_in_a_sentence(self):
        scene = next(scene for scene in SCENES if has_water(scene))
        result = self.validate(PRESETS / "accurate.xml", scene, scene)
        self.assertEqual(result.returncode, BAD_INPUT, result.stdout)
        self.assertIn('"Order in Time" 2 and "Free Surface" do not go together', result.stdout)

    def used(self, scene, *options):
        """The parameters of a step, by the names of their lists."""
        output = Path(self.folder.name) / "used"
        simulate(scene, output, "--steps", "1", "--set", "Domain/Cells={24, 12}", *options)
        root = ElementTree.parse(output / "used-parameters.xml").getroot()
        return lambda *names: root.find("/".join([*(f"ParameterList[@name='{name}']" for name in names[:-1]), f"Parameter[@name='{names[-1]}']"])).get("value")

    def test_what_wins(self):
        scene = ROOT / "xml-params/scenes/pendulum-in-water.xml"  # names the coupling "flux"
        fast = PRESETS / "fast.xml"
        self.assertEqual(self.used(self.both(fast, scene))("Coupling", "Type"), "mixed face")
        self.assertEqual(self.used(self.both(scene, fast))("Coupling", "Type"), "flux")
        own = '<ParameterList name="Fluid"><Parameter name="Advection" type="string" value="cubic"/></ParameterList>'
        self.assertEqual(self.used(self.both(fast, scene, own))("Fluid", "Advection"), "cubic")

    def test_the_command_line_includes_before_the_scene(self):
        used = self.used(ROOT / "xml-params/scenes/pendulum-in-water.xml", "--set", "Include=../presets/fast.xml")
        self.assertEqual(used("Coupling", "Type"), "mixed face")

    def test_a_preset_before_the_scene_names_the_strategy(self):
        used = self.used(self.both(PRESETS / "paper.xml", ROOT / "xml-params/scenes/pendulum-in-water.xml"))
        self.assertEqual(used("Solver", "Strategy", "Type"), "paper")
        self.assertEqual(used("Solver", "Strategy", "Solid Inverse", "Type"), "Block Diagonal Mass")

    def test_soft_solids_that_are_silent_are_those_of_the_paper(self):
        scene = ROOT / "xml-params/scenes/cloth-in-stream.xml"
        size = ("--set", "Domain/Cells={12, 8, 8}", "--set", "Solids/Cloth/Geometry/Mesh Spacing=0.2")
        self.assertEqual(self.used(scene, *size)("Solids", "Cloth", "Time Integration"), "fully-implicit")
        self.assertEqual(self.used(self.both(PRESETS / "paper.xml", scene), *size)("Solids", "Cloth", "Time Integration"), "semi-implicit")

    def test_every_line_says_why(self):
        for file in sorted(PRESETS.glob("*.xml")):
            lines = file.read_text().splitlines()
            for before, line in zip(lines, lines[1:]):
                if "<Parameter " in line:
                    with self.subTest(preset=file.stem, line=line.strip()):
                        self.assertRegex(before, r"-->$")
                        self.assertTrue(re.match(r"  ", line))


if __name__ == "__main__":
    unittest.main()
