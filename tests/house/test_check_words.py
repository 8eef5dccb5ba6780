"""Each rule of tools/check-words must find a comment that breaks it, and leave a proper one alone."""
import importlib.machinery
import importlib.util
import tempfile
import unittest
from pathlib import Path

TOOL = Path(__file__).resolve().parents[2] / "tools/check-words"


def load():
    loader = importlib.machinery.SourceFileLoader("check_words", str(TOOL))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("check_words", loader))
    loader.exec_module(module)
    return module


words = load()


class Rules(unittest.TestCase):
    def found(self, text, language="cpp", **tables):
        return list(words.violations_of_file("src/a.cpp", text, language, **tables))

    def test_comments_with_a_subject(self):
        for comment in ("/// Momentum of the predicted velocity u*, summed over the ranks [kg m/s].", "/// Returns the density.",
                        "int n = 0;  ///< number of rows", "/// Where the grid ends, values are extrapolated.", "/// u* := u^n",
                        'const char* text = "// What is in a text is none";', "/// Offsets of rows, of which each has one."):
            with self.subTest(comment=comment):
                self.assertEqual(self.found(comment + "\n"), [])

    def test_comments_without_a_subject(self):
        for comment in ("/// Of u*.", "// What the grid sees.", "double volume = 0;  ///< of all of them [m^dim]", "/// The same for cells.",
                        "/// Whether a cell is wet.", "/// Those of this rank.", "/// Where it is.", "/// And the rest.", "/// : density"):
            with self.subTest(comment=comment):
                self.assertEqual([line for line, _ in self.found("int i;\n\n" + comment + "\n")], [3])

    def test_a_block_is_one_comment_and_a_paragraph_is_another(self):
        self.assertEqual(self.found("/// The sum\n/// of all rows.\n"), [])
        self.assertEqual([line for line, _ in self.found("/// The sum.\n///\n/// Of all rows.\n")], [3])

    def test_python_and_other_files(self):
        self.assertEqual([line for line, _ in self.found('def f():\n    """What it says."""\n    x = 1  # of the row\n', "python")], [2, 3])
        self.assertEqual(self.found("set(name \"# Of a text\")\n# Flags of the compiler.\n", "hash"), [])
        self.assertEqual(len(self.found("# Which flags there are.\n", "hash")), 1)

    def test_words(self):
        table = {"void": ("air", ["src/old"])}
        self.assertEqual(len(self.found("/// Pressure in the voids [Pa].\n", words=table)), 1)
        self.assertEqual(self.found("/// Pressure in `void` and voids.hpp [Pa].\nvoid f();\n", words=table), [])
        self.assertEqual(list(words.violations_of_file("src/old/a.cpp", "/// The void.\n", "cpp", words=table)), [])

    def test_names(self):
        table = {"unlinear": ("nonlinear", []), "FaceWorth": ("FaceCoefficients", [])}
        for text in ("int unlinear_bodies = 0;", "class UnlinearSolids;", "FaceWorth worth;", "bool isUnlinear();"):
            with self.subTest(text=text):
                self.assertEqual(len(self.found(text + "\n", names=table)), 1)
        self.assertEqual(self.found("int nonlinear = 0;  // unlinear\nint FaceWorths;\n", words={}, names=table), [])

    def test_the_list_of_folders_shrinks_only(self):
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "src/linear").mkdir(parents=True)
            file = Path(folder) / "src/linear/a.cpp"
            file.write_text("// What it is.\nint i;\n// What it was.\n")
            self.assertEqual(list(words.violations(folder, {"src/linear": 2})), [])
            self.assertEqual(len(list(words.violations(folder, {}))), 2)
            self.assertIn("more than the 1 that are left", "\n".join(words.violations(folder, {"src/linear": 1})))
            file.write_text("int i;\n")
            self.assertIn("is clean", "\n".join(words.violations(folder, {"src/linear": 1})))


if __name__ == "__main__":
    unittest.main()
