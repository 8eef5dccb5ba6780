"""Faults of the machine: a killed run, signals, a full disk, a damaged checkpoint."""
import contextlib
import csv
import os
import signal
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

import h5py
import numpy

from program import SCENE, SIMULATE, command, simulate

N_STEPS = 50  # of the whole run
CHECKPOINTS = ["--set", "Output/Checkpoint Interval=0.1"]


def read_table(path):
    """All columns but the wall time, as text: equal text is equal bit for bit."""
    lines = [line for line in path.read_text().splitlines() if not line.startswith("#")]
    return [{name: text for name, text in row.items() if name != "wall_seconds"} for row in csv.DictReader(lines)]


def read_last_frame(path):
    """The datasets of the last frame, after a look at all of them."""
    fields = {}
    with h5py.File(path) as file:
        for name in sorted(name for name in file if name.startswith("frame-")):
            fields = {}
            file[name].visititems(
                lambda item, data: fields.update({item: data[...]}) if isinstance(data, h5py.Dataset) else None)
            assert fields, f"{name} is empty"
    return fields


def newest_checkpoint(folder):
    found = sorted((Path(folder) / "output").glob("checkpoint-*.h5"))
    return found[-1] if found else None


@contextlib.contextmanager
def started(folder, *arguments):
    """A run in the background; ended with the block."""
    (Path(folder) / "scene.xml").write_text(SCENE)
    process = subprocess.Popen(command(folder, *arguments), stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    try:
        yield process
    finally:
        if process.poll() is None:
            process.kill()
        process.communicate()


def wait_for(condition, process, seconds=60):
    end = time.monotonic() + seconds
    while not condition():
        if process.poll() is not None:
            raise AssertionError(f"the run ended too early with {process.returncode}: {process.stdout.read()}")
        if time.monotonic() > end:
            raise AssertionError("waited too long")
        time.sleep(0.002)


class Faults(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.straight = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.straight.cleanup)
        result = simulate(cls.straight.name)
        assert result.returncode == 0, result.stderr

    def assert_equals_straight_run(self, folder, straight=None):
        for name in ("history.csv", "bodies.csv"):
            found, expected = (read_table(Path(where) / "output" / name)
                               for where in (folder, straight or self.straight.name))
            self.assertEqual(len(expected), N_STEPS)
            self.assertEqual(found, expected, name)
        found, expected = (read_last_frame(Path(where) / "output" / "frames.h5")
                           for where in (folder, straight or self.straight.name))
        self.assertEqual(found.keys(), expected.keys())
        for name in expected:
            self.assertTrue(numpy.array_equal(found[name], expected[name]), f"{name} of the last frame")

    def assert_restarts(self, folder):
        result = simulate(folder, "--restart", newest_checkpoint(folder))
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assert_equals_straight_run(folder)

    def test_killed_between_frames(self):
        with tempfile.TemporaryDirectory() as folder:
            with started(folder, *CHECKPOINTS) as process:
                wait_for(lambda: newest_checkpoint(folder), process)
                process.send_signal(signal.SIGKILL)
                self.assertEqual(process.wait(), -signal.SIGKILL)
            self.assertTrue(read_last_frame(Path(folder) / "output" / "frames.h5"))
            self.assert_restarts(folder)

    def test_signals(self):
        for number in (signal.SIGTERM, signal.SIGINT):
            with self.subTest(signal=number.name), tempfile.TemporaryDirectory() as folder:
                history = Path(folder) / "output" / "history.csv"
                with started(folder) as process:
                    wait_for(lambda: history.exists() and len(read_table(history)) > 2, process)
                    process.send_signal(number)
                    output, _ = process.communicate(timeout=60)
                    self.assertEqual(process.returncode, 128 + number, output)
                self.assertIsNotNone(newest_checkpoint(folder), output)
                self.assertIn("Stopped by signal", output)
                self.assert_restarts(folder)

    def test_restart_on_two_ranks(self):
        with tempfile.TemporaryDirectory() as straight, tempfile.TemporaryDirectory() as folder:
            self.assertEqual(simulate(straight, ranks=2).returncode, 0)
            self.assertEqual(simulate(folder, "--steps", 20, ranks=2).returncode, 0)
            result = simulate(folder, "--restart", newest_checkpoint(folder), ranks=2)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assert_equals_straight_run(folder, straight)

    def test_restart_on_other_ranks(self):
        with tempfile.TemporaryDirectory() as folder:
            self.assertEqual(simulate(folder, "--steps", 20, ranks=2).returncode, 0)
            result = simulate(folder, "--restart", newest_checkpoint(folder))
            self.assertEqual(result.returncode, 0, result.stderr)
            found, expected = (read_table(Path(where) / "output" / "bodies.csv")[-1]
                               for where in (folder, self.straight.name))
            for column in ("x", "y", "vx", "vy"):
                self.assertAlmostEqual(float(found[column]), float(expected[column]), delta=1e-6, msg=column)

    def test_truncated_checkpoint(self):
        with tempfile.TemporaryDirectory() as folder:
            self.assertEqual(simulate(folder, "--steps", 3).returncode, 0)
            checkpoint = newest_checkpoint(folder)
            whole = checkpoint.read_bytes()
            for n_bytes in (len(whole) // 2, 100, 0):
                checkpoint.write_bytes(whole[:n_bytes])
                result = simulate(folder, "--restart", checkpoint)
                with self.subTest(n_bytes=n_bytes):
                    self.assertEqual(result.returncode, 4, result.stderr)
                    self.assertIn("is truncated or damaged, restart from an earlier one", result.stderr)
                    self.assertIn(checkpoint.name, result.stderr)

    def test_checkpoint_of_another_grid(self):
        with tempfile.TemporaryDirectory() as folder:
            self.assertEqual(simulate(folder, "--steps", 3).returncode, 0)
            result = simulate(folder, "--restart", newest_checkpoint(folder), "--set", "Domain/Cells={14, 28}")
            self.assertEqual(result.returncode, 2, result.stderr)
            self.assertIn("Checkpoint", result.stderr)

    def test_full_disk(self):
        with tempfile.TemporaryDirectory() as folder:
            output = Path(folder) / "output"
            output.mkdir()
            mount = ["mount", "-t", "tmpfs", "-o", "size=256k", "tmpfs", str(output)]
            if os.geteuid() != 0 or subprocess.run(mount, stderr=subprocess.DEVNULL).returncode != 0:
                self.skipTest("a small disk of its own needs root and the right to mount")
            try:
                result = simulate(folder)
                self.assertEqual(result.returncode, 4, result.stderr)
                self.assertEqual(result.stderr.count("lockstep: "), 1, result.stderr)
                self.assertIn("No space left on device", result.stderr)
                self.assertTrue(read_last_frame(output / "frames.h5"), "frames finished before that")
                self.assertTrue(read_table(output / "history.csv"))
            finally:
                subprocess.run(["umount", str(output)], check=True)


if __name__ == "__main__":
    if not Path(SIMULATE).exists():
        raise SystemExit(f"{SIMULATE} is missing; set LOCKSTEP_SIMULATE to the program to test.")
    unittest.main()
