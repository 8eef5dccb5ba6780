"""Messages of the measuring tools about builds that are not there and runs that fail."""
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

TOOL = Path(__file__).resolve().parents[2] / "tools" / "measure-swimming"


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


if __name__ == "__main__":
    unittest.main()
