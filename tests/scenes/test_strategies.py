"""Every strategy that is shipped solves a tank with heavy solids, by the inverses that it takes by itself, to the answer of
the exact one."""
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/support"))
from simulation import assert_close, simulate, table  # noqa: E402

SCENE = ROOT / "tests/parallel/ball-and-shell.xml"
SETTINGS = ("Domain/Cells={16,16,16}", "Solids/Ball/Density=30000", "Solids/Plate/Surface Density=3000", "Time/End=0.03",
            "Solver/Tolerance=1e-10")
MOTION = ("vx", "vy", "vz", "wx", "wy", "wz")


class Strategies(unittest.TestCase):
    def motion(self, solver):
        with tempfile.TemporaryDirectory() as folder:
            options = [word for setting in (*SETTINGS, f"Solver/File={solver}") for word in ("--set", setting)]
            simulate(SCENE, Path(folder) / "run", *options)
            return table(Path(folder) / "run/bodies.csv")

    def test_strategies(self):
        solvers = sorted((ROOT / "xml-params/solvers").glob("*.xml"))
        exact = self.motion(next(file for file in solvers if file.stem == "direct"))
        for file in solvers:
            with self.subTest(file.stem):
                assert_close(exact, self.motion(file), MOTION, 1e-6)


if __name__ == "__main__":
    unittest.main()
