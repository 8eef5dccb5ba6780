"""Checks the documentation, as far as this can be done without reading it. Usage: test_docs.py ROOT

- links between pages lead to files, and to headings that exist; pictures are there
- code quoted from a file stands in it literally; a quotation begins with a comment line that names
  the file: <!-- from: template/driver.cpp -->
- every page of docs/results stands in their list, holds every series of its study, and names a commit of this history
- formulas are such as GitHub sets, too, whose Markdown reads them first
- paths of the tree in backticks exist, and in `file.cpp: function` the file defines it; names of code files without a
  path are those of files
"""
import csv
import re
import subprocess
import sys
import unittest
import xml.etree.ElementTree
from pathlib import Path

ROOT = Path(sys.argv.pop(1)).resolve() if len(sys.argv) > 1 else Path(__file__).resolve().parents[2]
LINK = re.compile(r"\[[^\]]*\]\(([^)\s]+)\)")
COMMIT = re.compile(r"\b(?:from|commit|build of) ([0-9a-f]{7,40})\b(-dirty)?")
PICTURE = re.compile(r'<img src="([^"]+)"')
QUOTE = re.compile(r"<!-- from: (\S+) -->\n```\w*\n(.*?)```", re.DOTALL)
CODE = re.compile(r"```.*?```|`[^`\n]*`", re.DOTALL)
FORMULA = re.compile(r"\$\$(.+?)\$\$|(?<![\w\\$])\$(?!\s)([^$\n]+?)(?<!\s)\$(?![\w$])", re.DOTALL)
# A backslash before punctuation (write \cr, \thinspace), what may begin emphasis, a macro that GitHub forbids.
NOT_ON_GITHUB = re.compile(r"\\[^\w\s]|[^\w]_|\*|\\(?:operatorname|mbox|phantom)\b")
PATH = re.compile(r"`((?:src|packages|drivers|tests|docs|tools|template|cmake|xml-params)/[\w./*-]+)(?:: ([\w:~]+))?[^`]*`")

NAME = re.compile(r"`([\w-]+\.(?:cpp|hpp|py|js|cmake))(?:: ([\w:~]+))?`")
ROOMS = ("src", "packages", "drivers", "tests", "tools", "template", "cmake", "docs")


def pages():
    return [*sorted(ROOT.glob("*.md")), ROOT / "template" / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]


def headings(page):
    """The anchors that GitHub and others make of headings."""
    found = re.findall(r"^#+ (.+)$", page.read_text(), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).strip().replace(" ", "-") for heading in found}


def squeezed(text):
    """Blanks and line breaks do not count: a quotation may be laid out differently."""
    return re.sub(r"\s", "", text)


def defines(file, name):
    """True if a .cpp file has the body of a function, a class, or a constant of this name; of others whether the word occurs."""
    text = file.read_text()
    if file.suffix != ".cpp":
        return bool(re.search(rf"\b{re.escape(name)}\b", text))
    if re.search(rf"\b(?:class|struct|enum class|namespace|using) {name}\b|\b(?:const|constexpr) [^;()]*\b{name}\b", text):
        return True
    for match in re.finditer(rf"\b{name}\(", text):
        depth, end = 1, match.end()
        while depth and end < len(text):
            depth += {"(": 1, ")": -1}.get(text[end], 0)
            end += 1
        if re.match(r"(?:\s|const\b|noexcept\b|override\b)*(?::(?!:)[^;]*?)?\{", text[end:]):
            return True
    return False


class Docs(unittest.TestCase):
    def test_links(self):
        for page in pages():
            text = page.read_text()
            for target in LINK.findall(text) + PICTURE.findall(text):
                if re.match(r"https?:|mailto:", target):
                    continue
                name, _, anchor = target.partition("#")
                path = (page.parent / name).resolve() if name else page
                with self.subTest(page=page.name, link=target):
                    self.assertTrue(path.exists())
                    if anchor and path.suffix == ".md":
                        self.assertIn(anchor, headings(path))

    def test_quotations(self):
        n_quotations = 0
        for page in pages():
            for name, code in QUOTE.findall(page.read_text()):
                n_quotations += 1
                with self.subTest(page=page.name, file=name):
                    text = squeezed((ROOT / name).read_text())
                    for part in re.split(r"^\s*(?://|#|<!--) \.\.\..*$", code, flags=re.MULTILINE):
                        self.assertIn(squeezed(part), text)
        self.assertGreater(n_quotations, 0)

    def test_formulas(self):
        n_formulas = 0
        for page in pages():
            text = CODE.sub("", page.read_text())
            for formula in FORMULA.finditer(text):
                n_formulas += 1
                with self.subTest(page=page.name, formula=formula[0]):
                    self.assertEqual(NOT_ON_GITHUB.findall(formula[0]), [])
            for words in re.findall(r"\[([^\]]*)\]\(", text):  # words of links, in which there is no formula
                self.assertNotIn("$", words, page.name)
        self.assertGreater(n_formulas, 200)

    def test_paths(self):
        for page in pages():
            for name, word in PATH.findall(page.read_text()):
                with self.subTest(page=page.name, path=name):
                    found = sorted(ROOT.glob(name.rstrip("/")))
                    self.assertTrue(found)
                    if word:
                        last = word.split("::")[-1]
                        self.assertTrue(any(defines(file, last) for file in found), f"{name} does not define {last}")

    def test_names_of_code_files(self):
        files = {}
        for room in ROOMS:
            for file in (ROOT / room).rglob("*.*"):
                files.setdefault(file.name, []).append(file)
        for page in pages():
            for name, word in NAME.findall(page.read_text()):
                with self.subTest(page=page.name, file=name):
                    self.assertTrue(name in files, "there is no such file")
                    if word:
                        last = word.split("::")[-1]
                        self.assertTrue(any(re.search(rf"\b{re.escape(last)}\b", file.read_text()) for file in files[name]),
                                        f"no {last} in {name}")

    def test_pages_of_results_are_listed(self):
        results = ROOT / "docs" / "results"
        index = (results / "README.md").read_text()
        for page in sorted(results.glob("*.md")):
            if page.name != "README.md":
                with self.subTest(page=page.name):
                    self.assertIn(f"`{page.stem}`", index)

    def test_pages_hold_every_series(self):
        for page in sorted((ROOT / "docs" / "results").glob("*.csv")):
            study = ROOT / "xml-params" / "studies" / f"{page.stem}.xml"
            if not study.exists():
                continue
            series = xml.etree.ElementTree.parse(study).getroot().find("ParameterList[@name='Series']")
            rows = csv.reader(line for line in page.read_text().splitlines() if not line.startswith("#"))
            shown = {row[0] for row in rows}
            for one in series if series is not None else ():
                with self.subTest(page=page.name, series=one.get("name")):
                    self.assertIn(one.get("name").replace(",", ";"), shown)

    def test_sizes_that_scenes_name_make_cubes(self):
        """Sizes in the comment of a scene, "Domain/Cells={160, 240, 160}", and those that PaperSize makes are cubes."""
        n_sizes = 0
        for scene in sorted((ROOT / "xml-params/scenes").glob("*.xml")):
            text = scene.read_text()
            sizes = re.findall(r'"Domain/Cells=\{([^}]*)\}"', text)
            if "[PaperSize" in text:
                cells = re.search(r'name="Cells"[^>]*value="\{([^}]*)\}"', text).group(1)
                sizes += [re.sub(r"\[PaperSize \? (\d+) : (\d+)\]", choice, cells) for choice in (r"\1", r"\2")]
            for cells in sizes:
                lower, upper = (re.search(rf'name="{name}"[^>]*value="\{{([^}}]*)\}}"', text).group(1) for name in ("Lower", "Upper"))
                edges = [(float(u) - float(v)) / float(n) for u, v, n in zip(upper.split(","), lower.split(","), cells.split(","))]
                n_sizes += 1
                with self.subTest(scene=scene.name, cells=cells):
                    self.assertAlmostEqual(min(edges) / max(edges), 1, delta=1e-9)
        self.assertGreater(n_sizes, 18)

    def test_pictures_are_small(self):
        for picture in sorted([*(ROOT / "docs").rglob("*.png"), *(ROOT / "docs").rglob("*.jpg")]):
            with self.subTest(picture=picture.name):
                self.assertLessEqual(picture.stat().st_size, 300_000)

    def test_pages_can_be_made_again(self):
        if git("rev-parse", "--is-shallow-repository") != "false":
            self.skipTest("needs the whole history")
        for page in sorted((ROOT / "docs" / "results").glob("*.md")):
            commits = COMMIT.findall(page.read_text())
            with self.subTest(page=page.name):
                self.assertTrue(commits or page.name == "README.md", "the page names no commit")
            for commit, is_dirty in commits:
                with self.subTest(page=page.name, commit=commit):
                    self.assertFalse(is_dirty)
                    self.assertEqual(git("merge-base", commit, "HEAD")[: len(commit)], commit)


def git(*arguments):
    """Output of git, or nothing where there is no repository."""
    found = subprocess.run(["git", "-C", str(ROOT), *arguments], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    return found.stdout.strip()


if __name__ == "__main__":
    unittest.main()
