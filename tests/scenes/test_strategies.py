"""Every strategy and list that is shipped solves a tank with heavy solids, by the inverses that it takes by itself, to the
answer of the exact one; and Belos with Teko every shipped scene to that of the default."""
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests/support"), str(ROOT / "tools")]
from histories import OF_CONTACT, compare_runs, has_contact  # noqa: E402
from run_scene import coarse_cells  # noqa: E402
from scene_xml import xml  # noqa: E402
from simulation import assert_close, simulate, table  # noqa: E402

SCENE = ROOT / "tests/parallel/ball-and-shell.xml"
SETTINGS = ("Domain/Cells={16,16,16}", "Solids/Ball/Density=30000", "Solids/Plate/Surface Density=3000", "Time/End=0.03",
            "Solver/Tolerance=1e-10")
# The partitioned iteration diverges with the plate, whose added mass is large; of least squares the plate's motions in its
# own plane, which the fluid does not feel, have none.
CONTROLS = {"uzawa", "lsc"}
MOTION = ("vx", "vy", "vz", "wx", "wy", "wz")


class Strategies(unittest.TestCase):
    def motion(self, solver):
        with tempfile.TemporaryDirectory() as folder:
            options = [word for setting in (*SETTINGS, f"Solver/File={solver}") for word in ("--set", setting)]
            simulate(SCENE, Path(folder) / "run", *options)
            return table(Path(folder) / "run/bodies.csv")

    def test_strategies(self):
        solvers = sorted(file for file in (ROOT / "xml-params/solvers").glob("*.xml") if file.stem not in CONTROLS)
        exact = self.motion(next(file for file in solvers if file.stem == "direct"))
        for file in solvers:
            with self.subTest(file.stem):
                assert_close(exact, self.motion(file), MOTION, 1e-6)

    def test_every_scene_by_belos_and_teko(self):
        """Every shipped scene, coarse: MINRES with Teko's block preconditioner, on two ranks, and the paper's solver find what the
        default finds; with contacts and limits, which solves and decisions agree on to 1e-5 of g dt, to a little less."""
        for scene in sorted((ROOT / "xml-params/scenes").glob("*.xml")):
            cells = "{" + ", ".join(map(str, coarse_cells(scene))) + "}"
            with self.subTest(scene.stem), tempfile.TemporaryDirectory() as folder:
                ranks = {"schur-cg": 1, "minres-teko": 2, "paper": 1}
                runs = [Path(folder) / solver for solver in ranks]
                contact = ["--set", OF_CONTACT] if has_contact(scene) else []
                # Where air of 1e-3 meets water, 1e-11 is round-off of the pressures in the water.
                tolerance = 1e-10 if '<ParameterList name="Gas">' in scene.read_text() else 1e-11
                for run in runs:
                    simulate(scene, run, "--steps", "3", "--set", f"Domain/Cells={cells}", "--set", "Output/Frames=false", *contact,
                             "--set", f"Solver/Tolerance={tolerance}", "--set", "Solver/Viscous Solve/Tolerance=3e-13",
                             "--set", f"Solver/File={ROOT}/xml-params/solvers/{run.name}.xml", ranks=ranks[run.name])
                most = 1e-7 if contact else 1e-8
                for other in runs[1:]:
                    greatest = compare_runs([runs[0], other], most).greatest()
                    self.assertLess(greatest.size, most, f"{other.name}: {greatest}")

    def test_lightness_costs_pressure_schur_nothing(self):
        """Where C is 1e-7 of the fluid's, Woodbury's formula has only the round-off of a multigrid in single precision left."""
        def iterations(density):
            scene = {"Dimension": 2, "Domain": {"Upper": (1., 1.), "Cells": (24, 24)}, "Fluid": {"Gravity": (0., -9.8)},
                     "Solids": {"Ball": {"Type": "rigid body", "Geometry": {"Shape": "ball", "Radius": .15}, "Density": density,
                                         "Position": (.5, .5)}},
                     "Coupling": {"Type": "flux"}, "Solver": {"Strategy": {"Type": "pressure-schur"}},
                     "Time": {"Fixed Step": .01}, "Output": {"Frames": False}}
            with tempfile.TemporaryDirectory() as folder:
                file = Path(folder) / "ball.xml"
                file.write_text(xml("Scene", scene))
                simulate(file, Path(folder) / "run", "--steps", "2")
                return max(float(row["s2_iterations"]) for row in table(Path(folder) / "run/history.csv"))

        reference = iterations(500.)
        for density in (1e-3, 1e-4, 1e-6):
            self.assertLess(iterations(density), 2 * reference)


if __name__ == "__main__":
    unittest.main()
