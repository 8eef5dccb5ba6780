"""tools/compare-histories: what counts as a difference, and how large; a page of programs that write tables of their own."""
import csv
import json
import math
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
TOOL = ROOT / "tools" / "compare-histories"
sys.path.insert(0, str(ROOT / "tools"))
from histories import Table, compare, read_table  # noqa: E402

UNITS = {"step": "1", "dt": "s", "s1_iterations": "1", "contacts": "1", "cfl": "1", "momentum_x": "kg m/s", "momentum_y": "kg m/s", "energy": "J",
         "momentum_error": "1"}
ROW = {"dt": 0.5, "s1_iterations": 7, "contacts": 3, "cfl": 0.25, "momentum_x": 0., "momentum_y": 4., "energy": 8., "momentum_error": 1e-16}
LENGTH = 0.25


def table(units, rows, name=""):
    return Table(dict(units), {(step, name): {key: str(value) for key, value in row.items()} for step, row in enumerate(rows, 1)})


def history(*changes):
    """Two steps; `changes`: of (step, column, value)."""
    rows = [dict(ROW, energy=4.), dict(ROW)]
    for step, column, value in changes:
        rows[step - 1][column] = value
    return {"history": table(UNITS, rows)}


def compared(a, b):
    return compare([a, b], LENGTH, 1e-10)


class Histories(unittest.TestCase):
    def test_the_same(self):
        found = compared(history(), history())
        self.assertEqual(found.greatest().size, 0)
        self.assertIsNone(found.first())
        self.assertEqual(found.n_numbers, 2 * 6)

    def test_columns_of_an_older_program_have_their_present_names(self):
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "history.csv"
            file.write_text("# gas_pockets [1]: of air\nstep,gas_pockets,dt\n1,2,0.5\n")
            self.assertEqual(read_table(file), Table({"gas_bubbles": "1"}, {(1, ""): {"step": "1", "gas_bubbles": "2", "dt": "0.5"}}))

    def test_a_part_in_a_billion(self):
        for column, name in (("energy", "history energy, step 2"), ("momentum_y", "history momentum_y, step 2"), ("cfl", "history cfl, step 2")):
            found = compared(history(), history((2, column, ROW[column] * (1 + 1e-9))))
            self.assertAlmostEqual(found.greatest().size, 1e-9, delta=1e-12)
            self.assertEqual(str(found.greatest()), name)
            self.assertEqual(found.first().first, 2)

    def test_over_the_greatest_of_the_run(self):
        self.assertAlmostEqual(compared(history(), history((1, "energy", 4 + 8e-9))).greatest().size, 1e-9, delta=1e-12)

    def test_what_is_zero_by_symmetry_is_over_its_vector(self):
        self.assertAlmostEqual(compared(history(), history((1, "momentum_x", 4e-9))).greatest().size, 1e-9, delta=1e-12)

    def test_what_is_round_off_in_a_fluid_at_rest(self):
        self.assertEqual(compared(history((1, "cfl", 1e-15), (2, "cfl", 1e-15)), history((1, "cfl", 2e-15), (2, "cfl", 0.))).greatest().size, 1e-14)

    def test_the_first_is_of_the_first_step(self):
        found = compared(history(), history((1, "energy", 4 + 8e-9), (2, "energy", 8 + 8e-9), (2, "cfl", 0.5)))
        self.assertEqual(found.greatest().column, "history cfl")
        self.assertEqual((found.first().column, found.first().first), ("history energy", 1))

    def test_what_tells_of_the_solving_is_left_out(self):
        self.assertEqual(compared(history(), history((1, "s1_iterations", 9), (2, "momentum_error", 1.))).greatest().size, 0)

    def test_counts(self):
        found = compared(history(), history((2, "contacts", 4)))
        self.assertEqual(found.greatest().size, 0)
        self.assertEqual(found.counts, {"history contacts": 2})

    def test_nan(self):
        self.assertEqual(compared(history((1, "energy", math.nan)), history()).greatest().size, math.inf)
        self.assertEqual(compared(history((1, "energy", math.nan)), history((1, "energy", math.nan))).greatest().size, 0)
        self.assertEqual(compared(history((1, "contacts", math.nan)), history()).greatest().size, math.inf)

    def test_what_one_run_lacks(self):
        short = history()
        del short["history"].rows[2, ""]
        self.assertEqual(compared(history(), short).first().first, 2)
        narrow = history()
        del narrow["history"].units["energy"]
        for row in narrow["history"].rows.values():
            del row["energy"]
        for pair in ((history(), narrow), (narrow, history())):
            self.assertEqual(str(compared(*pair).greatest()), "history energy, step 1")
            self.assertEqual(compared(*pair).greatest().size, math.inf)
        more = dict(history(), gauge=table({"height": "m"}, [{"height": 1}]))
        self.assertEqual(compared(history(), more).greatest().column, "gauge.csv in one run alone")

    def test_scales_of_bodies(self):
        """A spin of nothing is over a tenth of 1/dt = 2 rad/s; a force of nothing, over a tenth of 4 kg m/s / .5 s; a ball that
        moves a hundredth as fast as another, over a tenth of the speed of that."""
        units = {"x": "m", "vx": "m/s", "vy": "m/s", "wz": "rad/s", "fx": "N"}
        row = {"x": 1., "vx": 0., "vy": 50., "wz": 0., "fx": 0.}
        slow = dict(row, vy=0.5)

        def bodies(**change):
            both = table(units, [row], "Fast")
            both.rows |= table(units, [dict(slow, **change)], "Slow").rows
            return dict(history(), bodies=both)
        for change, size in (({"wz": 2e-10}, 1e-9), ({"fx": 8e-10}, 1e-9), ({"vx": 5e-9}, 1e-9), ({"x": 1 + 1e-9}, 1e-9)):
            found = compared(bodies(), bodies(**change)).greatest()
            self.assertAlmostEqual(found.size, size, delta=1e-12)
            self.assertEqual((found.column, found.name), (f"bodies {next(iter(change))}", "Slow"))


SCRIPT = """#!/usr/bin/python3
import pathlib, sys
if "--version" in sys.argv:
    sys.exit(print("lockstep 0.1.0 (0123456789ab)"))
if {fails} and sys.argv[1].endswith("/b.xml"):
    sys.exit("lockstep: no such parameter")
folder = pathlib.Path(sys.argv[sys.argv.index("--output") + 1])
(folder / "history.csv").write_text("# step [1]: number\\n# dt [s]: its length\\n# energy [J]: \\nstep,dt,energy\\n1,0.5,{energy}\\n")
(folder / "summary.json").write_text('{{"smallest_length": 0.25}}')
"""


class Page(unittest.TestCase):
    def compare(self, folder, *options):
        done = subprocess.run([TOOL, "--program", folder / "one", "--scenes", folder, "--output", folder, "--runs", folder / "runs", *options],
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        self.assertEqual(done.returncode, 0, done.stdout)
        with open(folder / "histories.csv") as file:
            return (folder / "histories.md").read_text(), list(csv.DictReader(file))

    def test_two_programs(self):
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            for scene in ("a", "b"):
                (folder / f"{scene}.xml").write_text("<ParameterList/>")
            for program, energy, fails in (("one", "8", False), ("two", "8.000000008", True)):
                (folder / program).write_text(SCRIPT.format(energy=energy, fails=fails))
                (folder / program).chmod(0o755)
            page, rows = self.compare(folder)
            self.assertEqual([float(row["greatest difference"]) for row in rows], [0, 0])
            self.assertIn("lockstep 0.1.0 (0123456789ab) on 1 rank, twice", page)
            self.assertIn("2 scenes, 2 of them without any difference; above 1e-10: none.", page)
            page, rows = self.compare(folder, "--against", folder / "two")
            self.assertAlmostEqual(float(rows[0]["greatest difference"]), 1e-9, delta=1e-12)
            self.assertEqual((rows[0]["where"], rows[0]["first above"]), ("history energy, step 1", "step 1: history energy"))
            self.assertEqual(rows[1]["greatest difference"], "inf")
            self.assertIn("the other does not run it: lockstep: no such parameter", page)
            self.assertIn("above 1e-10: a, b.", page)


if __name__ == "__main__":
    unittest.main()
