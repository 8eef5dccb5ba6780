"""Types the commands of docs/cookbooks as their pages show them, and holds what they print to what the pages say.

Usage: test_cookbooks.py ROOT BUILD_FOLDER
"""
import csv
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT, BUILD = (Path(argument).resolve() for argument in sys.argv[1:3])
del sys.argv[1:3]
BOOKS = ROOT / "docs" / "cookbooks"
NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:e[-+]?\d+)?")


def blocks(page, language):
    """The blocks of code of a page in this language; "" has what commands print."""
    return [code for found, code in re.findall(r"```(\w*)\n(.*?)```\n", (BOOKS / page).read_text(), re.DOTALL) if found == language]


def commands(page):
    return "".join(blocks(page, "sh"))


def is_near(text, stated):
    """Within a tenth, or one and a half of the last digit that is stated; of round-off and residuals within their decade."""
    value, expected = float(text), float(stated)
    if abs(expected) < 1e-6:
        return abs(value) <= 10 * abs(expected)
    digits = len(stated.partition(".")[2]) if "e" not in stated else 0
    return abs(value - expected) <= max(.1 * abs(expected), 1.5 * 10.0 ** -digits)


class Cookbooks(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        shutil.copytree(BOOKS, self.folder / "docs" / "cookbooks", ignore=shutil.ignore_patterns("*.png", "__pycache__"))
        (self.folder / "build").mkdir()
        (self.folder / "build" / "release").symlink_to(BUILD)
        for name in ("tools", "tests", "xml-params"):
            (self.folder / name).symlink_to(ROOT / name)

    def cook(self, name):
        """Types the commands of a page, which must print what it says and draw its figure; returns what they print."""
        environment = {**os.environ, "PATH": f"{Path(sys.executable).parent}:{os.environ['PATH']}"}
        result = subprocess.run(["bash", "-e", "-c", commands("README.md") + commands(f"{name}.md")], cwd=self.folder, text=True,
                                env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=280)
        self.assertEqual(result.returncode, 0, result.stdout[-4000:])
        self.compare(name, result.stdout.splitlines())
        for picture in re.findall(r"!\[[^\]]*\]\(([^)]+)\)", (BOOKS / f"{name}.md").read_text()):
            self.assertTrue((self.folder / "output" / picture).exists(), picture)
        return result.stdout

    def compare(self, name, printed):
        stated = "".join(blocks(f"{name}.md", "")).splitlines()
        self.assertGreater(len(stated), 1)
        words = {NUMBER.sub("#", line): line for line in printed if line.strip()}
        for line in stated:
            key = NUMBER.sub("#", line)
            with self.subTest(page=name, line=line):
                self.assertIn(key, words, "\n".join(printed[-40:]))
                for value, expected in zip(NUMBER.findall(words[key]), NUMBER.findall(line)):
                    self.assertTrue(is_near(value, expected), words[key])

    def numbers(self, printed, pattern):
        """The numbers of a line, by a pattern in which # stands for each."""
        match = re.search(pattern.replace("#", f"({NUMBER.pattern})"), printed)
        self.assertTrue(match, printed)
        return [float(text) for text in match.groups()]

    def test_floating_body(self):
        printed = self.cook("floating-body")
        self.assertLess(self.numbers(printed, "difference # %")[0], 2)
        self.assertLess(self.numbers(printed, "R: # % off")[0], .6)

    @unittest.skipUnless((BUILD / "drivers" / "python" / "lockstep").is_dir(), "the Python package is not built")
    def test_cloth_in_stream(self):
        printed = self.cook("cloth-in-stream")
        force, apart = self.numbers(printed, "force # N/m, .*: # % apart")
        self.assertLess(abs(force - 242), 6)
        self.assertLess(apart, 2)
        self.assertLess(self.numbers(printed, "sag .*: # % apart")[0], 2)

    def test_added_mass(self):
        printed = self.cook("added-mass")
        off, order = self.numbers(printed, "flux: .* # % off .* order #")
        self.assertLess(off, .06)
        self.assertGreater(order, 1.5)
        off, order = self.numbers(printed, "mixed face: .* # % off .* order #")
        self.assertLess(off, 6)
        self.assertLess(abs(order - 1), .15)
        with (self.folder / "output" / "added-mass" / "study" / "table.csv").open() as file:
            rows = {(row["series"], int(row["cells"])): row for row in csv.DictReader(line for line in file if not line.startswith("#"))}
        stated = re.findall(r"^\| ([a-z ]+) \| (\d+) \| ([^|]+) \| [^|]+ \| ([^|]+) \|", (BOOKS / "added-mass.md").read_text(), re.MULTILINE)
        self.assertEqual(len(stated), len(rows))
        for series, n, value, error in stated:
            with self.subTest(series=series, n=n):
                row = rows[series, int(n) ** 2]
                self.assertLess(abs(float(row["value"]) - float(value)), 1e-3)
                self.assertLess(abs(float(row["error"]) / float(error) - 1), .1)

    def test_own_preconditioner(self):
        printed = self.cook("own-preconditioner")
        of_system = {name: self.numbers(printed, f"\n{name}: # iterations, # from") for name in ("schur-cg", "gauss-seidel", "triangle")}
        self.assertLess(3 * of_system["triangle"][0], of_system["gauss-seidel"][0])
        self.assertLess(max(error for _, error in of_system.values()), 5e-9)
        of_run = {name: self.numbers(printed, f"{name}, the run: # iterations")[0] for name in of_system}
        self.assertLess(4 * of_run["triangle"], min(of_run["schur-cg"], of_run["gauss-seidel"]))
        self.assertLess(self.numbers(printed, "at most # m apart")[0], 1e-9)

    def test_own_material(self):
        printed = self.cook("own-material")
        stress = {}
        for run in ("stiffening", "plain"):
            stress[run], law, apart = self.numbers(printed, f"{run}: .* # kPa, the law's # kPa; at most # % of that apart")
            self.assertLess(abs(stress[run] / law - 1), .002)
            self.assertLess(apart, .2)
        self.assertGreater(stress["stiffening"], 3 * stress["plain"])

    def test_every_page_is_tested(self):
        pages = {page.stem for page in BOOKS.glob("*.md")} - {"README"}
        self.assertEqual({f"test_{page.replace('-', '_')}" for page in pages} - set(dir(self)), set())


if __name__ == "__main__":
    unittest.main()
