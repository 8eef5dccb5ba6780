"""When frames, looks of observers and checkpoints come, in runs that go straight on and in runs that are restarted."""
import json
import sys
import tempfile
import unittest
from pathlib import Path

import h5py

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from scene_xml import xml  # noqa: E402
from simulation import simulate, table  # noqa: E402

# Steps of 0.01 s: 3, 5, 8, 10 are the first at or past multiples of 0.025 s; 11 is the end.
SCENE = xml("Scene", {
    "Dimension": 2, "Domain": {"Cells": (4, 4)}, "Fluid": {"Gravity": (0., -1.)},
    "Observers": {"gauge": {"Type": "points", "Points": (.5, .5), "Interval": .025}},
    "Output": {"Frame Interval": .025, "Checkpoints": {"Interval": .025, "Count": 99}},
    "Time": {"Start": -7., "End": -6.89, "Fixed Step": .01}})
DUE = [3, 5, 8, 10]


class OutputTimes(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.output = Path(folder.name) / "output"
        self.scene = Path(folder.name) / "scene.xml"
        self.scene.write_text(SCENE)

    def run_scene(self, *arguments, restart=None):
        more = ("--restart", self.output / f"checkpoint-{restart:06}.h5") if restart else ()
        simulate(self.scene, self.output, *arguments, *more)

    def frames(self):
        with h5py.File(self.output / "frames.h5") as file:
            return file["steps"][...].tolist()

    def looks(self):
        return [int(row["step"]) for row in table(self.output / "gauge.csv")]

    def checkpoints(self):
        return sorted(int(path.stem.split("-")[1]) for path in self.output.glob("checkpoint-*.h5"))

    def test_each_file_says_what_it_comes_from(self):
        """Frames, their index and checkpoints hold what the run would be done again from."""
        self.run_scene("--set", "Title=once more")
        parameters = (self.output / "used-parameters.xml").read_text()
        self.assertIn("once more", parameters)
        commit = json.loads((self.output / "summary.json").read_text())["versions"]["git"]
        files = [self.output / "frames.h5", *self.output.glob("frames/*.h5"), *self.output.glob("checkpoint-*.h5")]
        self.assertEqual(len(files), 1 + 6 + 5)
        for path in files:
            with self.subTest(file=path.name), h5py.File(path) as file:
                self.assertEqual(file.attrs["commit"], commit)
                self.assertEqual(file.attrs["scene"], "scene.xml")
                self.assertEqual(file.attrs["parameters"], parameters)

    def test_intervals_that_are_no_multiples_of_steps_do_not_drift(self):
        self.run_scene()
        self.assertEqual(self.frames(), [0, *DUE, 11])
        self.assertEqual(self.looks(), [0, *DUE, 11])
        self.assertEqual(self.checkpoints(), [*DUE, 11])

    def test_a_restarted_run_keeps_to_the_times_of_the_straight_one(self):
        self.run_scene("--set", "Output/Checkpoints/Interval=0.01")
        for step in (3, 4, 7):
            with self.subTest(step=step):
                self.run_scene(restart=step)
                self.assertEqual(self.frames(), [0, *DUE, 11])
                self.assertEqual(self.looks(), [0, *DUE, 11])
                self.assertEqual([n for n in self.checkpoints() if n > step], [n for n in (*DUE, 11) if n > step])
                self.run_scene("--set", "Output/Checkpoints/Interval=0.01")

    def test_what_came_at_an_end_that_is_none_any_more_is_dropped(self):
        """A frame and a look that a longer run would not have; the run that does not go on keeps them."""
        for end in (7, 8):
            with self.subTest(end=end):
                due = [n for n in (0, *DUE) if n < end]
                self.run_scene("--steps", end)
                for _ in range(2):
                    self.assertEqual(self.frames(), [*due, end])
                    self.assertEqual(self.looks(), [*due, end])
                    self.run_scene("--steps", end, restart=end)
                self.run_scene(restart=end)
                self.assertEqual(self.frames(), [0, *DUE, 11])
                self.assertEqual(self.looks(), [0, *DUE, 11])

    def test_a_run_of_no_interval_that_ends_looks_once(self):
        self.run_scene("--set", "Observers/gauge/Interval=0", "--set", "Output/Frame Interval=0", "--steps", 3)
        self.assertEqual(self.frames(), [0, 1, 2, 3])
        self.assertEqual(self.looks(), [0, 1, 2, 3])

    def test_about_a_hundred_frames_by_default(self):
        """One each hundredth of 275 steps, with the first step at or past it: 3, 6, 9, 11, 14, ..."""
        self.scene.write_text(SCENE.replace('<Parameter name="Frame Interval" type="double" value="0.025"/>', ""))
        steps = ("--set", "Time/Fixed Step=.0004", "--set", "Output/Checkpoints/Interval=.011")
        hundredths = [-(-n * 275 // 100) for n in range(101)]
        self.run_scene(*steps)
        self.assertEqual(self.frames(), hundredths)
        self.run_scene(*steps, restart=138)
        self.assertEqual(self.frames(), hundredths)

    def test_runs_of_few_steps_write_all_of_them_by_default(self):
        self.scene.write_text(SCENE.replace('<Parameter name="Frame Interval" type="double" value="0.025"/>', ""))
        self.run_scene("--set", "Time/Fixed Step=.0004", "--steps", 7)
        self.assertEqual(self.frames(), list(range(8)))


if __name__ == "__main__":
    unittest.main()
