"""Faults of the machine: a killed run, signals, a full disk, a damaged checkpoint."""
import contextlib
import csv
import io
import os
import resource
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

import h5py
import numpy

from program import SCENE, SIMULATE, command, simulate, with_checksum, without_checksum

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from scene_xml import xml  # noqa: E402

SOFT = """<Parameter name="Density" type="double" value="500"/>
      <ParameterList name="Material">
        <Parameter name="Young's Modulus" type="double" value="1e5"/>
      </ParameterList>
      <Parameter name="Time Integration" type="string" value="fully-implicit"/>"""
N_STEPS = 50  # steps of the whole run
CHECKPOINTS = ["--set", "Output/Checkpoints/Interval=0.1"]


def read_table(path):
    """All columns but the wall time, as text: equal text is equal bit for bit."""
    lines = [line for line in path.read_text().splitlines() if not line.startswith("#")]
    return [{name: text for name, text in row.items() if name != "wall_seconds"} for row in csv.DictReader(lines)]


def with_gauges(*names):
    """The scene, and as many gauges of the pressure above the ball, looked at each step."""
    gauges = "".join(f'<ParameterList name="{name}"><Parameter name="Type" type="string" value="points"/>'
                     '<Parameter name="Points" type="Array(double)" value="{.5, 1.5}"/></ParameterList>' for name in names)
    return SCENE.replace('  <ParameterList name="Time">', f'  <ParameterList name="Observers">{gauges}</ParameterList>\n'
                         '  <ParameterList name="Time">')


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
def started(folder, *arguments, scene=SCENE):
    """A run in the background; ended with the block."""
    (Path(folder) / "scene.xml").write_text(scene)
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
        for number in (signal.SIGTERM, signal.SIGINT, signal.SIGHUP, signal.SIGUSR1, signal.SIGUSR2, signal.SIGXCPU):
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

    def test_signals_that_end_no_run(self):
        """SIGPIPE, and what nohup has ignored; SIGXCPU, which comes each second, is no third signal."""
        with tempfile.TemporaryDirectory() as folder:
            history = Path(folder) / "output" / "history.csv"
            (Path(folder) / "scene.xml").write_text(SCENE)
            process = subprocess.Popen(["nohup", *command(folder)], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
            process.stdout.close()  # nobody reads the log any more
            wait_for(lambda: history.exists() and len(read_table(history)) > 2, process)
            process.send_signal(signal.SIGHUP)
            self.assertEqual(process.wait(), 0)
            self.assert_equals_straight_run(folder)
        with tempfile.TemporaryDirectory() as folder:
            history = Path(folder) / "output" / "history.csv"
            with started(folder) as process:
                wait_for(lambda: history.exists() and len(read_table(history)) > 2, process)
                process.send_signal(signal.SIGSTOP)
                for _ in range(4):
                    process.send_signal(signal.SIGXCPU)
                    process.send_signal(signal.SIGCONT)
                    time.sleep(.001)
                output, _ = process.communicate(timeout=60)
                self.assertEqual(process.returncode, 128 + signal.SIGXCPU, output)

    def test_one_run_at_a_time_in_a_folder(self):
        """Another one is refused and changes nothing; once the first has ended, be it by SIGKILL, the folder is free."""
        for ranks in (1, 2):
            with self.subTest(ranks=ranks), tempfile.TemporaryDirectory() as folder:
                output = Path(folder) / "output"
                with started(folder, *CHECKPOINTS, "--set", "Time/End=1e6") as process:
                    wait_for(lambda: newest_checkpoint(folder), process)
                    process.send_signal(signal.SIGSTOP)
                    before = {path: path.read_bytes() for path in output.rglob("*") if path.is_file()}
                    for more in ((), ("--restart", newest_checkpoint(folder))):
                        result = simulate(folder, *more, ranks=ranks)
                        self.assertEqual(result.returncode, 2, result.stderr)
                        self.assertEqual(result.stderr.count("lockstep: "), 1, result.stderr)
                        self.assertIn(f"Another run writes to '{output}': wait for it", result.stderr)
                    self.assertEqual({path: path.read_bytes() for path in output.rglob("*") if path.is_file()}, before)
                    process.kill()
                    process.wait()
                self.assertEqual(simulate(folder, "--steps", 3, ranks=ranks).returncode, 0)
                result = simulate(folder, "--restart", newest_checkpoint(folder), "--steps", 5, ranks=ranks)
                self.assertEqual(result.returncode, 0, result.stderr)

    def test_a_table_that_is_removed(self):
        """Rows that nobody would ever see are told of."""
        with tempfile.TemporaryDirectory() as folder:
            history = Path(folder) / "output" / "history.csv"
            with started(folder, "--set", "Time/End=1e6") as process:
                wait_for(lambda: history.exists() and len(read_table(history)) > 2, process)
                history.unlink()
                output, _ = process.communicate(timeout=60)
                self.assertEqual(process.returncode, 4, output)
                self.assertIn("history.csv' was removed while the run wrote to it", output)

    def test_a_folder_whose_name_is_no_text(self):
        """File names are bytes; what a page or a table says of them must be text all the same."""
        with tempfile.TemporaryDirectory() as folder:
            output = os.fsencode(folder) + b"/r\xe9sultat"
            (Path(folder) / "scene.xml").write_text(SCENE)
            for more in ([], ["--restart", output + b"/checkpoint-000002.h5"]):
                steps = "4" if more else "2"
                result = subprocess.run([SIMULATE, f"{folder}/scene.xml", "--output", output, "--steps", steps, *more],
                                        stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=60)
                self.assertEqual(result.returncode, 0, result.stderr)
            for name in (b"/summary.json", b"/frames.xmf", b"/used-parameters.xml", b"/history.csv"):
                Path(os.fsdecode(output + name)).read_text("utf-8")

    def test_a_limit_of_the_size_of_files(self):
        """It is told from the first file on."""
        for size in (16, 4096, 65536):
            with self.subTest(size=size), tempfile.TemporaryDirectory() as folder:
                (Path(folder) / "scene.xml").write_text(SCENE)
                result = subprocess.run(command(folder), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, timeout=60,
                                        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (size, size)))
                self.assertEqual(result.returncode, 4, result.stderr)
                self.assertIn("File too large", result.stderr)

    def test_signal_in_a_step(self):
        """The step is finished, and the checkpoint has it."""
        slow = SCENE.replace("rigid body", "deformable body").replace('<Parameter name="Density" type="double" value="500"/>', SOFT)
        with tempfile.TemporaryDirectory() as folder:
            self.assertEqual(simulate(folder, "--steps", 2, scene=slow).returncode, 0)
            other = Path(folder) / "other"
            again = ["--restart", newest_checkpoint(folder), "--set", "Solver/Newton Iterations=1000", "--output", other]
            with started(folder, *again, scene=slow) as process:
                wait_for(lambda: (other / "history.csv").exists(), process)
                time.sleep(0.3)
                process.send_signal(signal.SIGTERM)
                output, _ = process.communicate(timeout=120)
                self.assertEqual(process.returncode, 128 + signal.SIGTERM, output)
            steps = [int(row["step"]) for row in read_table(other / "history.csv")]
            with h5py.File(next(other.glob("checkpoint-*.h5"))) as checkpoint:
                self.assertEqual(checkpoint.attrs["step"], steps[-1])
            self.assertGreater(steps[-1], 2)

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

    def test_flipped_bytes(self):
        with tempfile.TemporaryDirectory() as folder:
            self.assertEqual(simulate(folder, "--steps", 3).returncode, 0)
            checkpoint = newest_checkpoint(folder)
            whole = checkpoint.read_bytes()
            places = [0, 9, *range(100, len(whole), len(whole) // 15), len(whole) - 70, len(whole) - 20, len(whole) - 1]
            for place in places:
                with self.subTest(place=place, of=len(whole)):
                    damaged = bytearray(whole)
                    damaged[place] ^= 1 << (place % 8)
                    checkpoint.write_bytes(damaged)
                    result = simulate(folder, "--restart", checkpoint)
                    self.assertEqual(result.returncode, 4, result.stderr)
                    self.assertEqual(result.stderr.count("lockstep: "), 1, result.stderr)
                    self.assertIn("is truncated or damaged, restart from an earlier one", result.stderr)
            self.assertTrue(read_table(Path(folder) / "output" / "history.csv"), "the old run must stay")

    def test_checkpoints_that_make_no_sense(self):
        """Their checksum is right, and something else than a run wrote them."""
        nothing, nan = numpy.zeros(0), float("nan")
        particles, counts = "fluid/interface_particles/values", "fluid/interface_particle_counts/values"

        def dataset(name, change):
            def edit(file):
                values = change(file[name][()])
                del file[name]
                file[name] = values
            return edit

        def one(new):
            def change(values):
                values.flat[values.size // 2] = new
                return values
            return change

        cases = {
            "text for numbers of cells": dataset("fluid/scaled_pressure/ids", lambda _: numpy.bytes_(b"text")),
            "a field of another shape": dataset("fluid/velocity/values", lambda values: values[:, :1]),
            "pressures of a cell missing": dataset("fluid/scaled_pressure/values", lambda values: values[:-1]),
            "an empty ledger": dataset("fluid/liquid_ledger", lambda _: nothing),
            "a particle that is nowhere": dataset(particles, one(nan)),
            "a particle far away": dataset(particles, one(1e9)),
            "too many particles": dataset(counts, one(2 ** 40)),
            "fewer particles than none": dataset(counts, one(-6)),
            "a cell of no kind": dataset("fluid/cells_with_pressure/values", one(77)),
            "a cell between two kinds": dataset("fluid/cells_with_pressure/values", one(.5)),
            "half a body": dataset("rigid bodies/values", lambda values: values[:3]),
            "a negative step": lambda file: file.attrs.__setitem__("step", -3),
            "a step that took less than no time": lambda file: file.attrs.__setitem__("last dt", -.1),
            "a frame that is yet to come": lambda file: file.attrs.__setitem__("last frame", 1e12),
            "a step of the fluid that took less than no time": lambda file: file["fluid"].attrs.__setitem__("last_step", -.1),
        }
        ball = {"Type": "rigid body", "Geometry": {"Shape": "ball", "Radius": .2}, "Density": 500., "Position": (.5, .5)}
        water = xml("Scene", {
            "Dimension": 2, "Domain": {"Cells": (16, 16)}, "Solids": {"Ball": ball}, "Time": {"Fixed Step": .01},
            "Fluid": {"Gravity": (0., -9.8), "Free Surface": {"Liquid": {"Pool": {"Type": "level", "Height": .4}}}}})
        gas_cases = {
            "bubbles without end": dataset("fluid/gas_bubble/values", one(1e9)),
            "half a bubble": dataset("fluid/gas_bubble/values", one(.5)),
            "less gas than none": dataset("fluid/gas_amount/values", one(-1.)),
        }
        hole = {name: {"Type": "box", "Lower": lower, "Upper": upper} for name, lower, upper in (
            ("Bottom", (-1., -1.), (2., .2)), ("Left", (-1., -1.), (.3, .9)), ("Right", (.7, -1.), (2., .9)),
            ("Top", (-1., .6), (2., .9)))}
        gas = xml("Scene", {
            "Dimension": 2, "Domain": {"Cells": (16, 16)}, "Time": {"Fixed Step": .001},
            "Fluid": {"Gravity": (0., -9.8), "Free Surface": {"Liquid": hole, "Trapped Air": "ideal gas"}}})
        for scene, edits in ((water, cases), (gas, gas_cases)):
            with tempfile.TemporaryDirectory() as folder:
                self.assertEqual(simulate(folder, "--steps", 2, scene=scene).returncode, 0)
                for name, edit in edits.items():
                    with self.subTest(name):
                        self.assert_refuses_edited_checkpoint(folder, scene, edit)

    def assert_refuses_edited_checkpoint(self, folder, scene, edit):
        checkpoint = newest_checkpoint(folder)
        whole = checkpoint.read_bytes()
        content = io.BytesIO(without_checksum(whole))
        with h5py.File(content, "r+") as file:
            edit(file)
        checkpoint.write_bytes(with_checksum(content.getvalue()))
        try:
            result = simulate(folder, "--restart", checkpoint, "--steps", 3, scene=scene)
            self.assertIn(result.returncode, (2, 4), result.stderr)
            self.assertEqual(len(result.stderr.strip().splitlines()), 1, result.stderr)
            self.assertIn(checkpoint.name, result.stderr)
        finally:
            checkpoint.write_bytes(whole)

    def test_checkpoint_of_another_scene(self):
        with tempfile.TemporaryDirectory() as folder:
            self.assertEqual(simulate(folder, "--steps", 3).returncode, 0)
            for setting, expected in [("Solids/Ball/Geometry/Radius=0.25", ["Radius", "was 0.3 and is 0.25 now"]),
                                      ("Domain/Upper={2, 4}", ["Domain/Upper", "was {1, 2} and is {2, 4} now"]),
                                      ("Solids/Ball/Density=400", ["Solids/Ball/Density"]),
                                      ("Fluid/Viscosity=0", ["Fluid/Viscosity"]),
                                      ("Domain/Sides/x upper/Type=open", ["Domain/Sides/x upper/Type"]),
                                      ("Time/Start=0.001", ["Time/Start", "was 0 and is 0.001 now"])]:
                with self.subTest(setting=setting):
                    result = simulate(folder, "--restart", newest_checkpoint(folder), "--set", setting)
                    self.assertEqual(result.returncode, 2, result.stderr)
                    for text in [*expected, "Checkpoint", "belongs to another scene"]:
                        self.assertIn(text, result.stderr)
            others = ["Time/End=0.06", "Time/CFL=0.5", "Time/Fixed Step=0.005", "Output/Precision=double",
                      "Solver/Tolerance=1e-9", "Solver/Strategy/Type=direct", "Title=longer"]
            result = simulate(folder, "--restart", newest_checkpoint(folder),
                              *(word for setting in others for word in ("--set", setting)))
            self.assertEqual(result.returncode, 0, result.stderr)

    def test_what_an_earlier_run_has_left(self):
        """Halves of checkpoints go; a run that begins anew removes tables of observers and joints that it has not."""
        joint = """<ParameterList name="Joints"> <ParameterList name="Neck"> <Parameter name="Type" type="string" value="hinge"/>
          <Parameter name="Solids" type="Array(string)" value="{space, Ball}"/>
          <Parameter name="Point" type="Array(double)" value="{0.5, 0.5}"/> </ParameterList> </ParameterList>"""
        jointed = with_gauges("old", "kept").replace('  <ParameterList name="Time">', joint + '  <ParameterList name="Time">')
        with tempfile.TemporaryDirectory() as folder:
            output = Path(folder) / "output"
            self.assertEqual(simulate(folder, "--steps", 3, scene=jointed).returncode, 0)
            for name in ("old.csv", "kept.csv", "joints.csv"):
                self.assertTrue((output / name).exists(), name)
            mine = [output / name for name in ("mine.csv", "checkpoint-1.h5.part.txt", "my checkpoint-1.h5.part")]
            half = [output / f"checkpoint-{step}.h5.part" for step in ("000001", "000009")]
            for path in (*mine, *half):
                path.write_text("text")
            result = simulate(folder, "--restart", newest_checkpoint(folder), "--steps", 4,
                              scene=jointed.replace('"old"', '"other"'))
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertFalse([path for path in half if path.exists()])
            self.assertTrue((output / "old.csv").exists(), "rows of the run that goes on")
            half[1].write_text("text")
            result = simulate(folder, "--steps", 2, scene=with_gauges("kept"))
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertFalse(half[1].exists())
            self.assertEqual([row["step"] for row in read_table(output / "kept.csv")], ["0", "1", "2"])
            for name in ("joints.csv", "other.csv"):
                self.assertFalse((output / name).exists(), name)
            for path in mine:
                self.assertEqual(path.read_text(), "text")
            self.assertTrue((output / "old.csv").exists(), "no record names it any more")

    def test_an_observer_that_is_new_at_a_restart(self):
        """It looks from the next step on; the one that was there goes on."""
        with tempfile.TemporaryDirectory() as folder:
            self.assertEqual(simulate(folder, "--steps", 3, scene=with_gauges("old")).returncode, 0)
            result = simulate(folder, "--restart", newest_checkpoint(folder), "--steps", 5, scene=with_gauges("old", "new"))
            self.assertEqual(result.returncode, 0, result.stderr)
            old, new = (read_table(Path(folder) / "output" / f"{name}.csv") for name in ("old", "new"))
            self.assertEqual([row["step"] for row in old], ["0", "1", "2", "3", "4", "5"])
            self.assertEqual(new, old[4:])

    def test_an_observer_that_cannot_see_leaves_an_earlier_run_alone(self):
        """--validate tells it, too."""
        blind = with_gauges("old").replace('value="points"', 'value="flow"').replace(
            '<Parameter name="Points" type="Array(double)" value="{.5, 1.5}"/>',
            '<Parameter name="Lower" type="Array(double)" value="{5, 0}"/><Parameter name="Upper" type="Array(double)" value="{5, 1}"/>')
        with tempfile.TemporaryDirectory() as folder:
            self.assertEqual(simulate(folder, "--steps", 3, scene=with_gauges("old")).returncode, 0)
            before = {path: path.read_bytes() for path in (Path(folder) / "output").rglob("*") if path.is_file()}
            for more in ((), ("--validate",), ("--restart", newest_checkpoint(folder))):
                with self.subTest(more=more):
                    result = simulate(folder, *more, scene=blind)
                    self.assertEqual(result.returncode, 2, result.stderr)
                    self.assertIn("outside of the fluid", result.stderr)
                    after = {path: path.read_bytes() for path in (Path(folder) / "output").rglob("*") if path.is_file()}
                    self.assertEqual(after, before)

    def test_an_observer_of_another_kind_leaves_an_earlier_run_alone(self):
        """Its table cannot go on; elsewhere it is a new one."""
        other = with_gauges("old").replace('value="points"', 'value="flow"').replace(
            '<Parameter name="Points" type="Array(double)" value="{.5, 1.5}"/>',
            '<Parameter name="Lower" type="Array(double)" value="{0, 1.5}"/><Parameter name="Upper" type="Array(double)" value="{1, 1.5}"/>')
        often = ("--set", "Output/Checkpoints/Interval=1e-9", "--set", "Output/Checkpoints/Count=10")
        with tempfile.TemporaryDirectory() as folder:
            self.assertEqual(simulate(folder, "--steps", 4, *often, scene=with_gauges("old")).returncode, 0)
            output = Path(folder) / "output"
            before = {path: path.read_bytes() for path in output.rglob("*") if path.is_file()}
            second = output / "checkpoint-000002.h5"
            self.assertIn(second, before)
            result = simulate(folder, "--restart", second, "--steps", 4, *often, scene=other)
            self.assertEqual(result.returncode, 2, result.stderr)
            self.assertIn("other columns", result.stderr)
            self.assertEqual({path: path.read_bytes() for path in output.rglob("*") if path.is_file()}, before)
            (output / "old.csv").unlink()
            result = simulate(folder, "--restart", second, "--steps", 4, *often, scene=other)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertEqual([row["step"] for row in read_table(output / "old.csv")], ["3", "4"])

    def test_checkpoint_of_another_mesh(self):
        square = "v 0.3 0.3 0\nv 0.7 0.3 0\nv 0.7 0.7 0\nv 0.3 0.7 0\nl 1 2 3 4 1\n"
        scene = SCENE.replace('"Shape" type="string" value="ball"', '"Shape" type="string" value="file"')
        scene = scene.replace('"Radius" type="double" value="0.3"', '"File" type="string" value="body.obj"')
        with tempfile.TemporaryDirectory() as folder:
            mesh = Path(folder) / "body.obj"
            mesh.write_text(square)
            result = simulate(folder, "--steps", 2, scene=scene)
            self.assertEqual(result.returncode, 0, result.stderr)
            mesh.write_text(square.replace("v 0.7 0.7", "v 0.7 0.65"))
            result = simulate(folder, "--restart", newest_checkpoint(folder), "--steps", 3, scene=scene)
            self.assertEqual(result.returncode, 2, result.stderr)
            self.assertIn("content of the file that \"Solids/Ball/Geometry/File\" names has changed", result.stderr)
            mesh.write_text(square)
            result = simulate(folder, "--restart", newest_checkpoint(folder), "--steps", 3, scene=scene)
            self.assertEqual(result.returncode, 0, result.stderr)

    def test_restart_from_no_name_keeps_the_old_run(self):
        with tempfile.TemporaryDirectory() as folder:
            self.assertEqual(simulate(folder, "--steps", 3).returncode, 0)
            before = {path: path.read_bytes() for path in Path(folder).rglob("*") if path.is_file()}
            result = simulate(folder, "--restart", "")
            self.assertEqual(result.returncode, 2, result.stderr)
            self.assertIn("--restart names no file", result.stderr)
            self.assertEqual({path: path.read_bytes() for path in before}, before)

    def assert_survives_full_disk(self, size, ranks=1):
        with tempfile.TemporaryDirectory() as folder:
            output = Path(folder) / "output"
            output.mkdir()
            mount = ["mount", "-t", "tmpfs", "-o", f"size={size}k", "tmpfs", str(output)]
            if os.geteuid() != 0 or subprocess.run(mount, stderr=subprocess.DEVNULL).returncode != 0:
                self.skipTest("a small disk of its own needs root and the right to mount")
            try:
                result = simulate(folder, ranks=ranks)
                self.assertEqual(result.returncode, 4, result.stderr)
                self.assertEqual(result.stderr.count("lockstep: "), 1, result.stderr)
                self.assertIn("No space left on device", result.stderr)
                if ranks == 1:
                    self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
                self.assertFalse([*output.rglob("*.part")])
                if size > 150:
                    self.assertTrue(read_last_frame(output / "frames.h5"), "frames finished before that")
                    self.assertTrue(read_table(output / "history.csv"))
            finally:
                subprocess.run(["umount", str(output)], check=True)

    def test_full_disk(self):
        # From the first file to frames and tables: whatever HDF5 was about to write, it does not break.
        for size in (16, 36, 40, 44, 48, 64, 256):
            with self.subTest(size=size):
                self.assert_survives_full_disk(size)

    def test_full_disk_on_two_ranks(self):
        self.assert_survives_full_disk(52, ranks=2)


if __name__ == "__main__":
    if not Path(SIMULATE).exists():
        raise SystemExit(f"{SIMULATE} is missing; set LOCKSTEP_SIMULATE to the program to test.")
    unittest.main()
