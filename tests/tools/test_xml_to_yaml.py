"""tools/xml-to-yaml: strings, numbers, arrays and comments of made-up files, shipped files as PyYAML reads them, what is refused."""
import math
import subprocess
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import yaml

LOADER = yaml.CSafeLoader

ROOT = Path(__file__).resolve().parents[2]
TOOL = ROOT / "tools/xml-to-yaml"
READ = {"double": float, "int": int, "string": str, "bool": lambda text: text in ("true", "yes", "1")}


def run(*arguments):
    return subprocess.run([TOOL, *map(str, arguments)], capture_output=True, text=True)


class XmlToYaml(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = Path(scratch.name)

    def convert(self, content):
        (self.folder / "a.xml").write_text(f"<ParameterList>{content}</ParameterList>")
        result = run(self.folder / "a.xml")
        self.assertEqual(result.returncode, 0, result.stderr)
        return result.stdout

    def value(self, kind, text):
        return yaml.safe_load(self.convert(f'<Parameter name="a" type="{kind}" value="{text}"/>'))["a"]

    def test_strings_stay_strings(self):
        for text in ("1", "1e-8", "true", "yes", "Off", "n", "~", "null", "", " a ", "a: b", "a #b", "[2*R]", "{a}", "- a", "*a", "&amp;a",
                     "!a", "a,b", "'", "&quot;", "%a", "@a", "`", "|", "&gt;", "?", "ä", "a\\b", "2024-01-01", "0x10", ".inf", "=", "a&#10;b"):
            with self.subTest(text):
                expected = ElementTree.fromstring(f'<a value="{text}"/>').get("value")
                self.assertEqual(self.value("string", text), expected)
                if "," not in text and "{" not in text and text.strip() == text != "":
                    self.assertEqual(self.value("Array(string)", f"{{{text}, b}}"), [expected, "b"])

    def test_numbers(self):
        for text in ("1", "-.5", "+2.", "1e-8", "1E+20", "123456789012345680000", "0.1", "5e-324", "1e22"):
            self.assertEqual(repr(self.value("double", text)), repr(float(text)), text)
        self.assertEqual(self.value("int", "+7"), 7)
        self.assertIs(self.value("bool", "yes"), True)
        self.assertEqual(self.value("double", "[2*R]"), "[2*R]")
        self.assertEqual(self.value("Array(double)", "{[min(a, b)], 1,-2}"), ["[min(a, b)]", 1., -2.])
        self.assertEqual(self.value("Array(int)", "{}"), [])

    def test_comments_and_lists(self):
        text = self.convert("""<!-- First,
     then. -->
  <Parameter name="a" type="int" value="1"/> <!-- behind -->
  <ParameterList name="1"> <!-- in front -->
    <!-- of b -->
    <Parameter name="b" type="bool" value="no"/>
  </ParameterList>
  <ParameterList name="empty"> <!-- nothing -->
  </ParameterList>
""")
        self.assertEqual(text, """# First,
# then.
a: 1  # behind
"1":
  # in front
  # of b
  b: false
empty: {}
  # nothing
""")
        self.assertEqual(self.convert(""), "{}\n")

    def test_shipped_files(self):
        for file in sorted((ROOT / "xml-params").glob("*/*.xml")):
            with self.subTest(file.name):
                result = run(file, self.folder / "a.yaml")
                self.assertEqual(result.returncode, 0, result.stderr)
                text = (self.folder / "a.yaml").read_text()
                self.same(ElementTree.parse(file).getroot(), yaml.load(text, LOADER))
                self.assertEqual(text.count("#") > 0, "<!--" in file.read_text())

    def same(self, element, given):
        children = [child for child in element]
        self.assertEqual([child.get("name") for child in children], list(given))
        for child in children:
            value, text = given[child.get("name")], child.get("value")
            if child.tag == "ParameterList":
                self.same(child, value)
            elif "[" in text and child.get("type") in ("double", "int"):
                self.assertEqual(value, text)
            elif child.get("type") in READ:
                self.assertEqual(value, READ[child.get("type")](text))
                self.assertIs(type(value), type(READ[child.get("type")](text)))
            else:
                self.assertIsInstance(value, list)
                numbers = [number for number in value if isinstance(number, float)]
                self.assertTrue(all(map(math.isfinite, numbers)))

    def test_refused(self):
        for content, expected in [('<Parameter name="a" type="double" value="x"/>', 'line 1: the value "x" is not a number'),
                                  ('<Parameter name="a" type="double" value="nan"/>', "not a number"),
                                  ('<Parameter name="a" type="float" value="1"/>', 'no type "float"'),
                                  ('<Parameter name="a" type="Array(int)" value="1"/>', "braces"),
                                  ('<Parameter name="a" value="1"/>', "needs a name"),
                                  ("<Other/>", "<Other> is no element"), ("<Param", "not well-formed")]:
            with self.subTest(content):
                (self.folder / "a.xml").write_text(f"<ParameterList>{content}</ParameterList>")
                result = run(self.folder / "a.xml", self.folder / "a.yaml")
                self.assertEqual(result.returncode, 2)
                self.assertIn(expected, result.stderr)
                self.assertFalse((self.folder / "a.yaml").exists())
        self.assertEqual(run(self.folder / "none.xml").returncode, 2)
        self.assertIn("must end in .yaml", run(self.folder / "a.xml", self.folder / "a.txt").stderr)


if __name__ == "__main__":
    unittest.main()
