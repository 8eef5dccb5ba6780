"""Pages that are written by hand have short sentences: 18 words in the mean, 40 at most. Usage: test_sentences.py ROOT

What a sentence is says tools/count-sentences; its rules are tested here, too.
"""
import importlib.machinery
import importlib.util
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(sys.argv.pop(1)).resolve() if len(sys.argv) > 1 else Path(__file__).resolve().parents[2]
PROGRAM = ROOT / "tools/count-sentences"
MEAN, MOST = 18, 40


def load(path):
    loader = importlib.machinery.SourceFileLoader("count_sentences", str(path))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("count_sentences", loader))
    loader.exec_module(module)
    return module


counter = load(PROGRAM)


class Pages(unittest.TestCase):
    def test_sentences_are_short(self):
        counts = []
        for page in counter.pages(ROOT):
            for line, sentence in counter.sentences(page.read_text()):
                counts.append(counter.n_words(sentence))
                with self.subTest(page=f"{page.relative_to(ROOT)}:{line}", sentence=sentence):
                    self.assertLessEqual(counts[-1], MOST, "split it")
        self.assertGreater(len(counts), 1000)
        self.assertLessEqual(counter.mean(counts), MEAN)

    def test_pages_are_those_written_by_hand(self):
        found = {str(page.relative_to(ROOT)) for page in counter.pages(ROOT)}
        self.assertLessEqual({"README.md", "docs/method.md", "docs/tutorials/write-a-scene.md"}, found)
        self.assertFalse([name for name in found if name.startswith(("docs/parameters/", "docs/results/"))])


class Rules(unittest.TestCase):
    def words(self, text):
        return [counter.n_words(sentence) for _, sentence in counter.sentences(text)]

    def test_ends(self):
        self.assertEqual(self.words("One two three. Four five six? Seven eight nine! Ten eleven twelve"), [3, 3, 3])
        self.assertEqual(self.words("It says so (and means it.) Then it goes on."), [6, 4])
        self.assertEqual(self.words('He said "this is it." The rest follows here.'), [5, 4])

    def test_abbreviations_and_names(self):
        self.assertEqual(self.words("See Fig. 3 and Eqs. 7: A. Author, B. Other et al. 2008 have more."), [15])
        self.assertEqual(self.words("The tank reaches 8 R. What is missing is the layer."), [5, 6])

    def test_decimals_and_files(self):
        self.assertEqual(self.words("A box of .5 m by 2.5 m, in box.xml or .github, is small."), [14])
        self.assertEqual(self.words("Of more than 200 every second, third, ... is taken."), [9])

    def test_words(self):
        self.assertEqual(self.words("The value of $a + b = c$ is `--set A = 1` here."), [7])
        self.assertEqual(self.words("See [the page of `x`](page.md#a-b-c) for *much* more."), [8])
        self.assertEqual(self.words("Air – and water - flow on."), [5])

    def test_lists(self):
        self.assertEqual(self.words("Three ways to go:\n\n- the first of them;\n- the second\n  of them.\n1. The last of them."), [4, 4, 4, 4])
        self.assertEqual(self.words("- [The idea](#the-idea)\n- [The step of it](#step)"), [], "links alone are no sentences")
        self.assertEqual(self.words("*Departure.* The paper says more."), [4], "a label is no sentence")

    def test_left_out(self):
        text = ("# A heading. With a stop.\n\n<!-- a comment. -->\n| a cell. | Another one. |\n|---|---|\n\n```sh\n# one two. Three four.\n```\n"
                "It gives the formula\n\n$$a = b. C$$\n\nwith a and b.\n")
        self.assertEqual(self.words(text), [4], "what a formula ends has no full stop, and counts only if it is too long")

    def test_long_text_counts_without_a_full_stop(self):
        self.assertEqual(self.words("word " * 41), [41])

    def test_lines(self):
        self.assertEqual([line for line, _ in counter.sentences("One two three.\n\n\n- Four five\n  six.\n- Seven eight nine.\n")], [1, 4, 6])

    def test_the_program_names_what_is_long(self):
        with tempfile.TemporaryDirectory() as folder:
            page = Path(folder) / "page.md"
            page.write_text("Short ones do well.\n\n" + "long " * 40 + "sentence.\n")
            run = subprocess.run([sys.executable, str(PROGRAM), str(page)], stdout=subprocess.PIPE, text=True, check=True)
            self.assertIn("1 above 40", run.stdout)
            self.assertIn(f"{page}:3: 41 words", run.stdout)
            missing = subprocess.run([sys.executable, str(PROGRAM), folder + "/none.md"], stderr=subprocess.PIPE, text=True)
            self.assertEqual(missing.returncode, 2)
            self.assertIn("There is no page", missing.stderr)


if __name__ == "__main__":
    unittest.main()
