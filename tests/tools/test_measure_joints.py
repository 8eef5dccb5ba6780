"""tools/measure-joints: what it measures of springs and of thrown mechanisms goes on a page. Usage: test_measure_joints.py BUILD"""
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

TOOL = Path(__file__).resolve().parents[2] / "tools" / "measure-joints"


class MeasureJoints(unittest.TestCase):
    def test_a_page(self):
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run([TOOL, "--build", sys.argv[1], "--only", "control", "stability", "--turns", "2", "--steps", "3", "--output", folder],
                                  stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
            self.assertEqual(done.returncode, 0, done.stdout)
            page = (Path(folder) / "joints.md").read_text()
            exact = re.search(r"`prescribed rate`.*\| ([0-9.e-]+) \|", page)
            self.assertLess(float(exact.group(1)), 1e-10)
            self.assertEqual(len(re.findall(r"\| (?:free|limits|contact|heavy|light|each joint twice) \| [+-]", page)), 5 * 6 + 1)
            self.assertIn("each joint twice", (Path(folder) / "joints.csv").read_text())


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
