"""A browser sets every formula of the manual, from the disk and without a network. Usage: test_formulas_in_browser.py"""
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/tools"))
from browser import Browser  # noqa: E402 (the path comes first)

WRONG = "[...document.querySelectorAll('.katex-error')].map(one => one.title)"


class Formulas(unittest.TestCase):
    def test_every_formula_is_set(self):
        with tempfile.TemporaryDirectory() as folder, Browser() as browser:
            subprocess.run([ROOT / "tools/make-manual", folder], check=True, stdout=subprocess.DEVNULL)
            for name in ("derivation", "method", "solvers", "water"):
                with self.subTest(page=name):
                    browser.open((Path(folder) / f"site/docs/{name}.html").as_uri())
                    browser.wait_for(f"location.pathname.endsWith('{name}.html') && document.readyState == 'complete'")
                    written = browser.run("document.querySelectorAll('.arithmatex').length")
                    self.assertGreater(written, 20)
                    self.assertEqual(browser.run("document.querySelectorAll('.arithmatex .katex').length"), written)
                    self.assertEqual(browser.run(WRONG), [])
                    # In their own fonts, and none is wider than the page.
                    self.assertTrue(browser.run("document.fonts.ready.then(() => document.fonts.check('16px KaTeX_Math'))"))
                    self.assertEqual(browser.run("[...document.querySelectorAll('.katex-display')]"
                                                 ".filter(one => one.scrollWidth > one.clientWidth).length"), 0)


if __name__ == "__main__":
    unittest.main()
