"""All mistakes of a scene are told in one run: shipped scenes with three of them each."""
import random
import re
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import building_mistakes
from program import simulate

SCENES = Path(__file__).resolve().parents[2] / "xml-params/scenes"
N_BUILDING = 60


def misspell(parameter):
    parameter.set("name", parameter.get("name") + "zz")
    return [parameter.get("name"), "is not a parameter"]


def damage_value(parameter):
    parameter.set("value", parameter.get("value") + "x" if parameter.get("type") != "string" else "")
    return [parameter.get("name"), f"(type \"{parameter.get('type')}\")"]


def change_type(parameter):
    parameter.set("type", "bool")
    parameter.set("value", "true")
    return [parameter.get("name"), "has type \"bool\""]


def name_no_type(parameter):
    parameter.set("type", "float")
    return [parameter.get("name"), "has the unknown type \"float\""]


def break_formula(parameter):
    parameter.set("value", "[2*nothing]")
    return [parameter.get("name"), "nothing"]


def mutations_of(parameter):
    """Mutations of a parameter that leave all other mistakes of the file to be seen."""
    kind, name = parameter.get("type"), parameter.get("name")
    if name in ("Type", "Shape", "Include", "Dimension"):  # they decide what else is valid
        return []
    found = [misspell, name_no_type] + [change_type] * (kind != "bool")
    if kind in ("double", "int"):
        found += [damage_value, break_formula]
    return found


def mutated(rng, text):
    """The scene with three mistakes in three parameters, and what the message must say of each."""
    tree = ElementTree.fromstring(text, ElementTree.XMLParser(target=ElementTree.TreeBuilder(insert_comments=True)))
    parents = {child: parent for parent in tree.iter() for child in parent}
    candidates = [item for item in tree.iter("Parameter") if mutations_of(item) and parents[item].get("name") not in
                  ("Constants", "Overrides", "Defaults")]
    chosen = rng.sample(candidates, 3)
    wanted = [rng.choice(mutations_of(parameter))(parameter) for parameter in chosen]
    return ElementTree.tostring(tree, encoding="unicode"), wanted


class ManyMistakes(unittest.TestCase):
    def message(self, text, folder, ranks=1):
        result = simulate(folder, "--validate", scene=text, ranks=ranks)
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertEqual(result.stderr.count("lockstep: "), 1, result.stderr)
        self.assertFalse((Path(folder) / "output").exists())
        return result.stderr

    def test_three_mistakes_in_shipped_scenes(self):
        for number, scene in enumerate(sorted(SCENES.glob("*.xml"))):
            with self.subTest(scene.name):
                text, wanted = mutated(random.Random(f"mistakes {number}"), scene.read_text())
                text = text.replace("../", f"{SCENES.parent}/")  # files that it names
                with tempfile.TemporaryDirectory() as folder:
                    for other in SCENES.glob("*.obj"):
                        (Path(folder) / other.name).symlink_to(other)
                    for other in SCENES.glob("*.xml"):
                        (Path(folder) / other.name).symlink_to(other)
                    message = self.message(text, folder)
                lines = message.splitlines()
                for words in wanted:
                    self.assertTrue(any(all(word in line for word in words) for line in lines), f"{words} in {message}")
                n_told = int(re.search(r"There are (\d+) mistakes", lines[0]).group(1))
                n_misspelt = sum("is not a parameter" in words for words in wanted)  # required parameters lack then, too
                self.assertLessEqual(n_told, len(wanted) + n_misspelt, message)

    def test_three_mistakes_of_building(self):
        """60 files of the shipped scenes, coarse, three mistakes in each that no schema knows of; nothing else is told."""
        scenes = [scene for scene in sorted(SCENES.glob("*.xml"))]
        for number in range(N_BUILDING):
            scene, rng = scenes[number % len(scenes)], random.Random(f"building {number}")
            names = building_mistakes.choose(rng, 3)
            with self.subTest(scene.name, number=number, names=names), tempfile.TemporaryDirectory() as folder:
                tree = ElementTree.fromstring(scene.read_text().replace("../", f"{SCENES.parent}/"))
                for other in [*SCENES.glob("*.obj"), *SCENES.glob("*.xml")]:
                    (Path(folder) / other.name).symlink_to(other)
                dimension = next(int(item.get("value")) for item in tree.iter("Parameter") if item.get("name") == "Dimension")
                mistakes = building_mistakes.Mistakes(tree, dimension)
                wanted = [getattr(mistakes, name)() for name in names]
                message = self.message(ElementTree.tostring(tree, encoding="unicode"), folder)
                lines = message.splitlines()
                self.assertEqual(lines[0], "lockstep: There are 3 mistakes:", message)
                for words in wanted:
                    self.assertTrue(any(all(word in line for word in words) for line in lines), f"{words} in {message}")

    def test_copies_are_told_once(self):
        """A thousand have the mistake of the solid they are copies of."""
        tree = ElementTree.fromstring((SCENES / "constraints-2d.xml").read_text().replace("../", f"{SCENES.parent}/"))
        copies = {"Type": "lattice", "Count": (10, 10), "Spacing": (1., 1.)}
        ball = building_mistakes.rigid(2, Locked=("x", "x"), Copies=copies)
        building_mistakes.put(building_mistakes.child(tree, "Solids"), {"Ball": ball})
        with tempfile.TemporaryDirectory() as folder:
            message = self.message(ElementTree.tostring(tree, encoding="unicode"), folder)
        self.assertNotIn("mistakes", message)
        self.assertIn('"Ball 1" has "x" twice in "Locked"; once is enough. The same holds for "Ball 2", "Ball 3"', message)
        self.assertIn("and 94 more.", message)

    def test_two_ranks_say_it_once(self):
        tree = ElementTree.fromstring((SCENES / "rag-doll.xml").read_text().replace("../", f"{SCENES.parent}/"))
        mistakes = building_mistakes.Mistakes(tree, 3)
        wanted = [mistakes.body_with_two_masses(), mistakes.cloth_on_nobody(), mistakes.joint_of_nobody()]
        with tempfile.TemporaryDirectory() as folder:
            message = self.message(ElementTree.tostring(tree, encoding="unicode"), folder, ranks=2)
        for words in wanted:
            self.assertIn(words[0], message)


if __name__ == "__main__":
    unittest.main()
