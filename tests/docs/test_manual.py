"""The site of tools/make-manual: every link and anchor of every page leads somewhere, search finds words, the API has the
interfaces, and a broken link stops it. Usage: test_manual.py"""
import json
import re
import shutil
import subprocess
import tempfile
import unittest
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

ROOT = Path(__file__).resolve().parents[2]


class Page(HTMLParser):
    def __init__(self, path):
        super().__init__()
        self.links, self.anchors = [], set()
        self.feed(path.read_text())

    def handle_starttag(self, tag, attributes):
        of = dict(attributes)
        self.anchors |= {of[name] for name in ("id", "name") if of.get(name)}
        self.links += [of[name] for name in ("href", "src") if of.get(name)]


class Manual(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        subprocess.run([ROOT / "tools/make-manual", folder.name], check=True, stdout=subprocess.DEVNULL)
        cls.site = Path(folder.name) / "site"
        cls.pages = {path: Page(path) for path in cls.site.rglob("*.html")}

    def test_links(self):
        n_anchors = 0
        for path, page in self.pages.items():
            if path.name == "404.html":
                continue  # written for any folder of a server
            for link in page.links:
                parts = urlsplit(link)
                if parts.scheme or parts.netloc or link.startswith(("javascript:", "data:")):
                    continue
                target = (path.parent / unquote(parts.path)).resolve() if parts.path else path
                with self.subTest(page=str(path.relative_to(self.site)), link=link):
                    self.assertTrue(target.exists())
                    if parts.fragment and target in self.pages and "api" not in path.parts:
                        n_anchors += 1
                        self.assertIn(unquote(parts.fragment), self.pages[target].anchors | {"__codelineno"})
        self.assertGreater(n_anchors, 300)

    def test_formulas_are_set(self):
        """Formulas between dollar signs go to the script that sets them, and the fonts are there."""
        for name in ("derivation", "method", "solvers", "water"):
            page = (self.site / f"docs/{name}.html").read_text()
            self.assertNotIn("$", re.sub(r"<script.*?</script>", "", page, flags=re.DOTALL))
            self.assertGreater(page.count('class="arithmatex"'), 20)
        self.assertIn("auto-render.min.js", page)
        self.assertTrue(list((self.site / "katex/fonts").glob("*.woff2")))
        shell = shutil.which("chromium-headless-shell")
        if shell:
            shown = subprocess.run([shell, "--no-sandbox", "--headless", "--virtual-time-budget=8000", "--dump-dom",
                                    (self.site / "docs/derivation.html").as_uri()], capture_output=True, text=True)
            self.assertGreater(shown.stdout.count('class="katex"'), 20)
            self.assertNotIn("katex-error", shown.stdout)

    def test_every_page_is_there_and_can_be_searched(self):
        written = {page.relative_to(ROOT).with_suffix(".html") for page in (ROOT / "docs").rglob("*.md")}
        there = {path.relative_to(self.site) for path in self.pages}
        self.assertEqual({page for page in written if page.name != "README.html"} - there, set())
        index = json.loads((self.site / "search/search_index.json").read_text())
        self.assertTrue(any("dual cell" in entry["text"] for entry in index["docs"]))

    def test_interfaces(self):
        names = set(re.findall(r"^(?:class|struct) (\w+) (?:final )?[:{]", "".join(
            header.read_text() for header in (ROOT / "src/interfaces").glob("*.hpp")), re.MULTILINE))
        self.assertGreater(len(names), 30)
        listed = (self.site / "api/annotated.html").read_text()
        self.assertEqual([name for name in names if not re.search(rf">{name}<", listed)], [])

    def test_nothing_is_loaded_from_elsewhere(self):
        for path, page in self.pages.items():
            text = path.read_text()
            loaded = re.findall(r"<(?:script|img|link rel=.stylesheet.)[^>]*(?:src|href)=.(https?:[^\"' ]*)", text)
            self.assertEqual(loaded, [], path)


class BrokenPages(unittest.TestCase):
    def test_a_broken_link_stops_it(self):
        with tempfile.TemporaryDirectory() as folder:
            copy = Path(folder) / "tree"
            for part in ("docs", "notebooks", "template", "xml-params", "tools", "src/interfaces"):
                shutil.copytree(ROOT / part, copy / part)
            for part in ("README.md", "CHANGELOG.md", "CITATION.cff", "CODE_OF_CONDUCT.md", "CONTRIBUTING.md", "LICENSE"):
                shutil.copy(ROOT / part, copy / part)
            page = copy / "docs/parallel.md"
            page.write_text(page.read_text() + "\nSee [there](not-there.md).\n")
            result = subprocess.run([copy / "tools/make-manual", Path(folder) / "out"], text=True,
                                    stdout=subprocess.PIPE, stderr=subprocess.PIPE)
            self.assertEqual(result.returncode, 2)
            self.assertIn("not-there.md", result.stderr)


if __name__ == "__main__":
    unittest.main()
