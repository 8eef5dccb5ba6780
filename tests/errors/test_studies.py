"""Studies: mistakes are found before anything runs, and a killed study leaves nothing that disturbs the next."""
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

from program import CONVERGE, SCENE, SIMULATE

STUDY = """<ParameterList name="Study">
  <Parameter name="Scene" type="string" value="scene.xml"/>
  <Parameter name="Set" type="string" value="Time/Steps=1; Output/Frames=false"/>
  <ParameterList name="Ladder">
    <Parameter name="Name" type="string" value="step"/>
    <Parameter name="Values" type="Array(double)" value="{0.01}"/>
  </ParameterList>
  <ParameterList name="Quantities">
    <ParameterList name="speed">
      <Parameter name="Expression" type="string" value="Ball.vy"/>
    </ParameterList>
  </ParameterList>
</ParameterList>
"""

# Stands in for simulate: tells who it is, then works for a long time.
SLEEPER = f"""#!{sys.executable}
import os, sys, time
folder = sys.argv[sys.argv.index("--output") + 1]
open(folder + "/child", "w").write(str(os.getpid()))
time.sleep(300)
"""


def lives(process):
    """True if a process with this number still works; a dead one that nobody has waited for does not."""
    try:
        return Path(f"/proc/{process}/stat").read_text().rsplit(")", 1)[1].split()[0] not in ("Z", "X")
    except OSError:
        return False


class Studies(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = Path(scratch.name)
        (self.folder / "scene.xml").write_text(SCENE)

    def command(self, *arguments, study=STUDY):
        (self.folder / "study.xml").write_text(study)
        return [CONVERGE, str(self.folder / "study.xml"), "--output", str(self.folder / "results"), *arguments]

    def converge(self, *arguments, study=STUDY):
        return subprocess.run(self.command(*arguments, study=study), stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                              text=True, timeout=300)

    def test_a_constant_h_is_the_size_of_the_cells(self):
        """A study drew its errors over the height of a wave, 0.2 m on every grid."""
        study = STUDY.replace('  <ParameterList name="Ladder">', """  <ParameterList name="Constants">
    <Parameter name="h" type="double" value="0.7"/>
  </ParameterList>
  <ParameterList name="Ladder">""", 1)
        done = self.converge(study=study)
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn('The constant "h" of the study is 0.7, but', done.stderr)

    def test_expressions_are_checked_first(self):
        for wrong, expected in [("Bal.vy", "Did you mean \"Ball.vy\""), ("Ball.vy +", "Quantity \"speed\""),
                                ("2 * gas_pockets", '"gas_pockets" is called "gas_bubbles" now')]:
            with self.subTest(wrong=wrong):
                result = self.converge(study=STUDY.replace("Ball.vy", wrong))
                self.assertEqual(result.returncode, 2, result.stderr)
                self.assertIn(expected, result.stderr)
                self.assertFalse((self.folder / "results").exists(), "nothing may have run")

    def test_absurd_numbers(self):
        for name, absurd in [("Samples", '<Parameter name="Count" type="int" value="2000000000"/>'),
                             ("Series", '<ParameterList name="a"><ParameterList name="Constants">'
                                        '<Parameter name="ranks" type="int" value="100000"/></ParameterList></ParameterList>')]:
            with self.subTest(name):
                part = f'<ParameterList name="{name}">{absurd}</ParameterList>\n  <ParameterList name="Quantities">'
                result = self.converge(study=STUDY.replace('<ParameterList name="Quantities">', part))
                self.assertEqual(result.returncode, 2, result.stderr)
                self.assertIn("at most", result.stderr)
                self.assertEqual(len(result.stderr.strip().splitlines()), 1, result.stderr)

    def test_what_cannot_be_read_leaves_the_rest(self):
        """Rows of an earlier call do not stay; a case without its frames is run anew."""
        study = STUDY.replace("Output/Frames=false", "Output/Frame Interval=0").replace(
            "    </ParameterList>\n  </ParameterList>\n</ParameterList>",
            """    </ParameterList>
    <ParameterList name="width">
      <Parameter name="Type" type="string" value="surface"/>
      <Parameter name="Solid" type="string" value="Ball"/>
      <Parameter name="Point" type="Array(double)" value="{0, 0}"/>
      <Parameter name="Expression" type="string" value="x_extent"/>
    </ParameterList>
  </ParameterList>
  <ParameterList name="Curves">
    <ParameterList name="bad"><Parameter name="Expression" type="string" value="1 / (step - 1)"/></ParameterList>
    <ParameterList name="good"><Parameter name="Expression" type="string" value="Ball.vy"/></ParameterList>
  </ParameterList>
</ParameterList>""")
        results = self.folder / "results"
        frames = results / "runs" / "all" / "step=0.01" / "frames"
        result = self.converge(study=study)
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertIn('the curve "bad" is not drawn', result.stderr)
        self.assertIn("good,all,", (results / "curves.csv").read_text())
        for frame in frames.glob("*.h5"):
            frame.write_bytes(b"no frame")
        result = self.converge(study=study.replace("Ball.vy", "Ball.vx"))
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertIn('"width" is not measured. Cannot read the frame', result.stderr)
        table = (results / "table.csv").read_text()
        self.assertIn(",speed,", table)
        self.assertNotIn(",width,", table)
        shutil.rmtree(frames)
        result = self.converge(study=study[:study.index('  <ParameterList name="Curves">')] + "</ParameterList>")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn(": done", result.stdout)
        self.assertIn(",width,", (results / "table.csv").read_text())
        self.assertFalse((results / "curves.csv").exists())

    def test_more_jobs_than_cases(self):
        result = self.converge("--jobs", "2000000000")
        self.assertEqual(result.returncode, 0, result.stderr)

    def test_a_changed_solver_file_is_noticed(self):
        solver = self.folder / "solver.xml"
        solver.write_text('<ParameterList name="s"><Parameter name="Type" type="string" value="direct"/></ParameterList>')
        study = STUDY.replace("Time/Steps=1", "Time/Steps=1; Solver/File=solver.xml")
        for expected in ("done", "used again"):
            result = self.converge(study=study)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertIn(f": {expected}", result.stdout)
        solver.write_text(solver.read_text() + "\n")
        self.assertIn(": done", self.converge(study=study).stdout)

    def test_a_killed_study(self):
        sleeper = self.folder / "sleeper"
        sleeper.write_text(SLEEPER)
        sleeper.chmod(0o755)
        child_file = self.folder / "results" / "runs" / "all" / "step=0.01" / "child"
        with subprocess.Popen(self.command("--simulate", str(sleeper)), stdout=subprocess.DEVNULL) as study:
            end = time.monotonic() + 60
            while not (child_file.exists() and child_file.read_text()):
                self.assertLess(time.monotonic(), end, "the study does not start")
                time.sleep(0.02)
            child = int(child_file.read_text())
            study.send_signal(signal.SIGKILL)
        end = time.monotonic() + 10
        while lives(child) and time.monotonic() < end:
            time.sleep(0.02)
        outlived = lives(child)
        if outlived:
            os.kill(child, signal.SIGKILL)
        self.assertFalse(outlived, "the run of a killed study works on")
        result = self.converge()
        self.assertEqual(result.returncode, 0, result.stderr)

    def hanging_simulate(self):
        """A simulate whose second case hangs as long as a file "hang" is there; that file."""
        hang = self.folder / "hang"
        hang.write_text("")
        program = self.folder / "simulate"
        program.write_text(f"#!/bin/sh\ncase $* in *Step=0.02*) while [ -e {hang} ]; do sleep 0.05; done ;; esac\n"
                           f"exec {SIMULATE} \"$@\"\n")
        program.chmod(0o755)
        return hang, ["--simulate", str(program)]

    def test_a_killed_study_goes_on_where_it_was(self):
        two = STUDY.replace("{0.01}", "{0.01, 0.02}").replace("Time/Steps=1", "Time/Steps=1; Time/Fixed Step=[step]")
        hang, options = self.hanging_simulate()
        with subprocess.Popen(self.command(*options, study=two), stdout=subprocess.PIPE, text=True) as study:
            self.assertRegex(study.stdout.readline(), r"^\[1/2\] all/step=0.01: done in [\d.]+ m?s$")
            study.send_signal(signal.SIGKILL)
        hang.unlink()
        first, second, *_ = self.converge(*options, study=two).stdout.splitlines()
        self.assertEqual(first, "[1/2] all/step=0.01: used again")
        self.assertRegex(second, r"^\[2/2\] all/step=0.02: done in [\d.]+ m?s$")

    def test_a_terminal_shows_what_runs(self):
        two = STUDY.replace("{0.01}", "{0.01, 0.02}").replace("Time/Steps=1", "Time/Steps=1; Time/Fixed Step=[step]")
        hang, options = self.hanging_simulate()
        terminal, end = os.openpty()
        with subprocess.Popen(self.command(*options, study=two), stdout=end, stderr=subprocess.DEVNULL) as study:
            os.close(end)
            shown, stop = b"", time.monotonic() + 60
            while b"1 of 2 after 1s; all/step=0.02 (starting)" not in shown:
                self.assertLess(time.monotonic(), stop, shown)
                shown += os.read(terminal, 1000)
            hang.unlink()
            while b"rows in" not in shown:
                shown += os.read(terminal, 1000)
        os.close(terminal)
        # The line is wiped away before another is written.
        self.assertRegex(shown.decode(), r"\r\x1b\[K\[2/2\] all/step=0.02: done in")

    def test_input_that_never_ends(self):
        os.mkfifo(self.folder / "pipe.xml")
        result = subprocess.run([CONVERGE, str(self.folder / "pipe.xml")], stderr=subprocess.PIPE, text=True,
                                timeout=60)
        self.assertNotEqual(result.returncode, 0)
        self.assertIn("pipe, not a file", result.stderr)


if __name__ == "__main__":
    if not Path(CONVERGE).exists():
        raise SystemExit(f"{CONVERGE} is missing; set LOCKSTEP_CONVERGE to the program to test.")
    unittest.main()
