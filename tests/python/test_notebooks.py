"""The notebooks run from top to bottom, in a short form, and what they find is what they say."""
import json
import os
import time
import unittest
from pathlib import Path

os.environ["LOCKSTEP_QUICK"] = "1"
os.environ["MPLBACKEND"] = "Agg"
FOLDER = Path(__file__).resolve().parents[2] / "notebooks"
SECONDS = 60  # most that one may take on one core


def cells(name):
    return json.loads((FOLDER / f"{name}.ipynb").read_text())["cells"]


def run(name):
    """The names that the code of a notebook leaves."""
    here, names = os.getcwd(), {"__name__": "__main__"}
    os.chdir(FOLDER)
    try:
        for number, cell in enumerate(cells(name)):
            if cell["cell_type"] == "code":
                exec(compile("".join(cell["source"]), f"{name}.ipynb, cell {number + 1}", "exec"), names)
    finally:
        os.chdir(here)
    return names


class Notebooks(unittest.TestCase):
    def timed(self, name):
        start = time.process_time()
        names = run(name)
        self.assertLess(time.process_time() - start, SECONDS)
        return names

    def test_floating_body(self):
        names = self.timed("floating-body")
        self.assertLess(names["draft_error"], .05)
        self.assertLess(names["force_error"], .05)
        self.assertTrue((names["folder"] / "box" / "draft.csv").exists())

    def test_error_against_cost(self):
        names = self.timed("error-against-cost")
        for coupling in ("flux", "mixed face"):
            errors = [names["errors"][coupling, n] for n in (32, 64, 128)]
            self.assertEqual(errors, sorted(errors, reverse=True))
            self.assertLess(errors[-1], .1)
        self.assertLess(names["errors"]["flux", 128], .005)

    def test_train_a_fish(self):
        names = self.timed("train-a-fish")
        self.assertEqual(sum(map(len, names["rewards"])), 6)
        self.assertGreater(names["best"][0], names["rewards"][0][0])

    def test_no_output_is_stored(self):
        self.assertEqual(len(list(FOLDER.glob("*.ipynb"))), 3)
        for file in FOLDER.glob("*.ipynb"):
            for cell in cells(file.stem):
                with self.subTest(file=file.name, cell=cell["id"]):
                    self.assertEqual((cell.get("outputs", []), cell.get("execution_count")), ([], None))


if __name__ == "__main__":
    unittest.main()
