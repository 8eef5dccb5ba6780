"""The common part of the measuring tools: messages about builds that are not there and runs that fail, stages of both scripts of a step."""
import json
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
TOOL = ROOT / "tools" / "measure-swimming"
sys.path.insert(0, str(ROOT / "tools"))
from measuring import environment, stages_of  # noqa: E402

SIMULATE = sys.argv.pop(1)


def message(build):
    done = subprocess.run([sys.executable, str(TOOL), "--only", "air", "--build", str(build)], capture_output=True, text=True)
    return done.returncode, done.stdout + done.stderr


class Measuring(unittest.TestCase):
    def test_failures_are_said(self):
        with tempfile.TemporaryDirectory() as folder:
            program = Path(folder).resolve() / "build" / "drivers" / "simulate"
            code, text = message(Path(folder) / "build")
            self.assertEqual(code, 1)
            self.assertIn(f"measure-swimming: there is no {program}", text)
            program.parent.mkdir(parents=True)
            program.write_text("#!/bin/sh\necho this does not converge\nexit 3\n")
            program.chmod(0o755)
            code, text = message(Path(folder) / "build")
            self.assertEqual(code, 1)
            for part in ("this does not converge", "a run ended with exit code 3", f"{program} ", "fish-2d.xml"):
                self.assertIn(part, text)
            self.assertNotIn("Traceback", text)

    def test_stages_have_the_same_names_in_both_scripts_of_a_step(self):
        names = []
        for order in (1, 2):
            with tempfile.TemporaryDirectory() as folder:
                subprocess.run([SIMULATE, ROOT / "xml-params/studies/added-mass-disc-scene.xml", "--steps", "2", "--quiet", "--output", folder,
                                "--set", f"Time/Order in Time={order}"], check=True, env=environment())
                seconds = stages_of(json.loads((Path(folder) / "summary.json").read_text()))
            names.append({name for name in seconds if name.count("/") == 1})
            for stage in ("S1", "F2", "F3 advection", "F3 forces", "S2", "S1 / iterations", "S2 / preconditioner"):
                self.assertGreater(seconds[f"step / {stage}"], 0, f"{stage}, order {order}")
        self.assertEqual(names[1] - names[0], set())


if __name__ == "__main__":
    unittest.main()
