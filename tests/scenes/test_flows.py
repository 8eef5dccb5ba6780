"""Flows that should stay as they are: what is far away, has left, or begins later changes nothing."""
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/support"))
from scene_xml import xml  # noqa: E402
sys.path.insert(0, str(ROOT / "tools"))
from lockstep_frames import read_frames  # noqa: E402
from simulation import column, simulate, table  # noqa: E402

PERIODIC = {"x lower": {"Type": "periodic"}, "x upper": {"Type": "periodic"}}
SLIPPERY = {"y lower": {"Type": "slip wall"}, "y upper": {"Type": "slip wall"}}
STREAM = (1., 0.)


def disc(x, y=.5, radius=.1):
    return {"Disc": {"Type": "rigid body", "Geometry": {"Shape": "ball", "Radius": radius}, "Density": 1000.,
                     "Position": (x, y), "Locked": ("x", "y", "rotation")}}


def smoke_at_the_end(output):
    return list(read_frames(output))[-1]["fluid"].values("smoke")


class Flows(unittest.TestCase):
    def run_scene(self, scene, steps, read=lambda output: table(output / "history.csv")):
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "scene.xml"
            file.write_text(xml("Scene", {"Dimension": 2, **scene}))
            simulate(file, Path(folder) / "run", "--steps", steps)
            return read(Path(folder) / "run")

    def assert_keeps_its_energy(self, history):
        energy = column(history, "fluid_kinetic_energy")
        self.assertGreater(energy[0], 0)
        for value in energy:
            self.assertAlmostEqual(value / energy[0], 1, delta=1e-9)

    def test_a_body_that_does_not_move_is_not_met_again_beyond_a_periodic_side(self):
        for x in (1.2, -.2):
            for coupling in ("mixed face", "flux"):
                with self.subTest(x=x, coupling=coupling):
                    self.assert_keeps_its_energy(self.run_scene({
                        "Domain": {"Lower": (0., 0.), "Upper": (1., 1.), "Cells": (20, 20), "Sides": {**PERIODIC, **SLIPPERY}},
                        "Fluid": {"Density": 1000., "Gravity": (0., 0.), "Velocity": STREAM},
                        "Solids": {"Disc": {"Type": "rigid body", "Geometry": {"Shape": "ball", "Radius": .1}, "Position": (x, .5),
                                            "Motion": {"Type": "static"}}}, "Coupling": {"Type": coupling}, "Time": {"End": 1., "Fixed Step": .02}}, 10))

    def smoke_downstream(self, start, ramp):
        """Smoke of a strip behind a disc, after two steps."""
        inflow = {"Type": "inflow", "Velocity": (f"min(max(t/{ramp}, 0), 1)", "0") if ramp else (1., 0.)}
        return self.run_scene({
            "Domain": {"Lower": (0., 0.), "Upper": (2., 1.), "Cells": (32, 16),
                       "Sides": {"x lower": inflow, "x upper": {"Type": "open"}, **SLIPPERY}},
            "Fluid": {"Density": 1000., "Gravity": (0., 0.), "Velocity": STREAM,
                      "Smoke": {"Ambient": 0., "Regions": {"Strip": {"Shape": "box", "Lower": (.9, -1.), "Upper": (1.3, 2.)}}}},
            "Solids": disc(.5), "Solver": {"Tolerance": 1e-12},
            "Time": {"Start": start, "End": start + .04, "Fixed Step": .02}}, 2, smoke_at_the_end)

    def test_a_run_that_starts_later_begins_with_the_inflow_of_then(self):
        there, expected = self.smoke_downstream(10., 1.), self.smoke_downstream(0., 0.)
        self.assertGreater(expected.max(), .5)
        self.assertLess(abs(there - expected).max(), 1e-9)

    def test_smoke_is_washed_out_of_cells_that_a_body_holds_in_part(self):
        clear = {"Type": "inflow", "Velocity": (1., 0.), "Smoke": 0.}
        smoke = self.run_scene({
            "Domain": {"Lower": (0., 0.), "Upper": (2., 1.), "Cells": (32, 16),
                       "Sides": {"x lower": clear, "x upper": {"Type": "open"}, **SLIPPERY}},
            "Fluid": {"Density": 1000., "Gravity": (0., 0.), "Velocity": STREAM,
                      "Smoke": {"Ambient": 0., "Regions": {"All": {"Shape": "box", "Lower": (-1., -1.),
                                                                   "Upper": (3., 2.)}}}},
            "Solids": disc(.5, radius=.22), "Coupling": {"Type": "flux"}, "Time": {"End": 4., "Fixed Step": .02}},
            200, smoke_at_the_end)
        before_the_disc = smoke[..., :8]
        self.assertLess(before_the_disc.max(), 1e-3)


if __name__ == "__main__":
    unittest.main()
