"""Gas that is trapped under water: a square bubble and the air in an upturned cup that floats, both of them free, for
both couplings; on two ranks, and continued from a checkpoint."""
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from scene_xml import xml  # noqa: E402
from simulation import assert_close, column, simulate, table, without_times  # noqa: E402

N_STEPS = 40


def box(lower, upper):
    return {"Type": "box", "Lower": lower, "Upper": upper}


def scene(air, coupling):
    """The bubble is what four boxes of water leave free; the cup's rim is under water."""
    water = {"Bottom": box((-2., -1.), (2., .3)), "Left": box((-2., -1.), (-.4, 1.)),
             "Right": box((-.15, -1.), (2., 1.)), "Top": box((-2., .55), (2., 1.))}
    return xml("Scene", {
        "Dimension": 2, "Domain": {"Lower": (-.75, 0.), "Upper": (.75, 1.5), "Cells": (48, 48)},
        "Fluid": {"Density": 1000., "Gravity": (0., -9.8), "Free Surface": {
            "Liquid": water, "Trapped Air": air, "Atmospheric Pressure": 2e4}},
        "Solids": {"Cup": {"Type": "rigid body", "Geometry": {"Shape": "open box", "Size": (.5, .4)}, "Mass": 60.,
                           "Position": (.3, 1.), "Rotation": 3.14159265358979}},
        "Coupling": {"Type": coupling}, "Solver": {"Tolerance": 1e-11},
        "Time": {"End": 10., "Fixed Step": .005},
        "Output": {"Frames": False, "Checkpoints": {"Interval": .1, "Count": 9}}})


class TrappedAir(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.root = Path(cls.folder.name)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def run_scene(self, air, coupling="mixed face", ranks=1, restart=None):
        """Rows of the history, and where the cup was; run once."""
        name = f"{air}-{coupling}-{ranks}{'-again' if restart else ''}".replace(" ", "_")
        output = self.root / name
        if not output.exists():
            file = self.root / f"{name}.xml"
            file.write_text(scene(air, coupling))
            more = ("--restart", restart) if restart else ()
            simulate(file, output, "--steps", N_STEPS, *more, ranks=ranks)
        return table(output / "history.csv"), column(table(output / "bodies.csv"), "y")

    def test_the_momentum_of_all_is_kept(self):
        for air in ("ideal gas", "constant volume"):
            for coupling in ("mixed face", "flux"):
                with self.subTest(air=air, coupling=coupling):
                    rows, _ = self.run_scene(air, coupling)
                    self.assertLess(max(column(rows, "momentum_error")), 1e-12)
                    self.assertLess(max(column(rows, "angular_momentum_error")), 1e-12)

    def test_a_gas_that_cannot_be_compressed_keeps_its_volume(self):
        for coupling in ("mixed face", "flux"):
            rows, _ = self.run_scene("constant volume", coupling)
            volumes = column(rows, "gas_volume")
            # Air at constant pressure loses half of it in that time.
            self.assertLess(max(abs(v / volumes[0] - 1) for v in volumes), 0.02)

    def test_the_gas_under_a_shell_is_measured_up_to_it(self):
        """A plate from side to side at nine places between the centres of two rows of cells."""
        for coupling in ("mixed face", "flux"):
            for k in range(9):
                height = (16.5 + .11 * (k + .5)) / 24
                text = xml("Scene", {
                    "Dimension": 2, "Domain": {"Cells": (24, 24)},
                    "Fluid": {"Density": 1000., "Gravity": (0., -9.8), "Free Surface": {
                        "Liquid": {"Pool": {"Type": "level", "Height": .31}}, "Trapped Air": "ideal gas"}},
                    "Solids": {"Lid": {"Type": "rigid body", "Geometry": {"Shape": "plate", "Size": (1.2, 0.), "Normal": "y"},
                                       "Position": (.5, height), "Motion": {"Type": "static"}}},
                    "Coupling": {"Type": coupling}, "Time": {"End": 1., "Fixed Step": .001}, "Output": {"Frames": False}})
                file, output = self.root / "lid.xml", self.root / f"lid-{coupling}-{k}"
                file.write_text(text)
                simulate(file, output, "--steps", 1)
                row, = table(output / "history.csv")
                self.assertEqual(row["gas_bubbles"], "1")
                self.assertAlmostEqual(float(row["gas_volume"]), height - .31, delta=1e-6)

    def test_air_carries_the_cup(self):
        """It weighs 60 kg; the walls alone, which have no volume, would carry nothing."""
        _, with_air = self.run_scene("ideal gas")
        _, without = self.run_scene("massless")
        self.assertGreater(with_air[-1] - without[-1], 0.05)

    def test_two_ranks(self):
        for air in ("ideal gas", "constant volume"):
            rows, heights = self.run_scene(air)
            shared, shared_heights = self.run_scene(air, ranks=2)
            assert_close(rows, shared, ("gas_volume", "gas_pressure"), 1e-5)
            for one, two in zip(heights, shared_heights):
                self.assertAlmostEqual(one, two, delta=1e-7)

    def test_restart(self):
        for air in ("ideal gas", "constant volume"):
            rows, heights = self.run_scene(air)
            checkpoint = min(self.root.glob(f"{air}-mixed_face-1/checkpoint*.h5".replace(" ", "_")))
            again, heights_again = self.run_scene(air, restart=checkpoint)
            self.assertEqual(heights_again, heights[-len(heights_again):])
            self.assertLess(len(again), len(rows))
            self.assertEqual(without_times(again), without_times(rows[-len(again):]))


if __name__ == "__main__":
    unittest.main()
