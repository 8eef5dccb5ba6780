"""Tiles that come and go: a plume and a disc that sinks away from it, against the same with all tiles stored, on any
number of ranks, and continued from a checkpoint."""
import shutil
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from scene_xml import xml  # noqa: E402
from simulation import FLUID, STATE, assert_close, simulate, table, without_times  # noqa: E402

N_STEPS = 40


def plume(tiles):
    fluid = {"Density": 1.2, "Viscosity": 1e-3, "Gravity": (0., -9.8), "Smoke Weight": -.2, "Smoke": {"Ambient": 0.},
             "Temperature": {"Ambient": 300.},
             "Sources": {"Fire": {"Shape": "ball", "Center": (-1., .6), "Radius": .3, "Smoke": 1.,
                                  "Temperature": 350.}}}
    if tiles:
        fluid["Moving Tiles"] = {}
    return xml("Scene", {
        "Dimension": 2, "Domain": {"Lower": (-3., 0.), "Upper": (3., 16.), "Cells": (96, 256)}, "Fluid": fluid,
        "Solids": {"Disc": {"Type": "rigid body", "Geometry": {"Shape": "ball", "Radius": .3}, "Density": 1.6,
                            "Position": (1., 13.)}},
        "Solver": {"Tolerance": 1e-10},
        "Time": {"End": 2., "Fixed Step": .025}, "Output": {"Checkpoints": {"Interval": .25, "Count": 9}}})


def dam_break(tiles):
    """A column of water that falls in a tall tank."""
    fluid = {"Density": 1000., "Gravity": (0., -9.8),
             "Free Surface": {"Liquid": {"Column": {"Type": "box", "Lower": (-1., -1.), "Upper": (.8, 1.2)}}}}
    if tiles:
        fluid["Moving Tiles"] = {}
    return xml("Scene", {
        "Dimension": 2, "Domain": {"Lower": (0., 0.), "Upper": (2., 12.), "Cells": (48, 288)}, "Fluid": fluid,
        "Solver": {"Tolerance": 1e-11},
        "Time": {"End": 2., "Fixed Step": .02}, "Output": {"Checkpoints": {"Interval": .4, "Count": 9}}})


def few_tiles(tiles):
    """A plume so small that some ranks have no tile at the start."""
    return plume(tiles).replace('{96, 256}', '{24, 64}')


SCENES = {"plume": plume, "few": few_tiles, "dam": dam_break}


class MovingTiles(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.root = Path(cls.folder.name)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def run_scene(self, name, tiles=True, ranks=1, restart=None, steps=N_STEPS, scene="plume"):
        """Histories of fluid and disc, run once a name."""
        output = self.root / name
        if restart:
            output = Path(shutil.copytree(output, f"{output}-again-{ranks}"))
        if restart or not output.exists():
            file = self.root / f"{scene}-{'tiles' if tiles else 'all'}.xml"
            file.write_text(SCENES[scene](tiles))
            more = ("--restart", output / restart) if restart else ()
            simulate(file, output, "--steps", steps, *more, ranks=ranks)
        return table(output / "history.csv"), table(output / "bodies.csv")

    def test_moves_as_with_all_tiles(self):
        all_history, all_bodies = self.run_scene("all", tiles=False)
        history, bodies = self.run_scene("tiles")
        assert_close(all_bodies, bodies, ("y", "vy"), .01)
        assert_close(all_history, history, ("fluid_kinetic_energy",), .02)
        for row in history:
            self.assertLessEqual(float(row["momentum_error"]), 1e-10)
            self.assertLessEqual(float(row["max_divergence"]), 1e-6)

    def test_tiles_come_and_go(self):
        history, _ = self.run_scene("tiles")
        volumes = [float(row["liquid_volume"]) for row in history]
        self.assertLess(max(volumes), .7 * 96)
        self.assertLess(volumes[0], .3 * 96)
        self.assertGreater(len(set(volumes)), 5)

    def test_is_the_same_on_any_number_of_ranks(self):
        history, bodies = self.run_scene("tiles")
        for ranks, steps in ((2, N_STEPS), (3, 8)):
            other, other_bodies = self.run_scene(f"ranks-{ranks}", ranks=ranks, steps=steps)
            assert_close(bodies[:steps], other_bodies, STATE, 1e-8)
            assert_close(history[:steps], other, FLUID, 1e-8)

    def test_goes_on_from_a_checkpoint_bit_for_bit(self):
        for ranks in (1, 2):
            name = "tiles" if ranks == 1 else f"ranks-{ranks}"
            history, bodies = self.run_scene(name, ranks=ranks)
            again, bodies_again = self.run_scene(name, ranks=ranks, restart="checkpoint-000020.h5")
            self.assertEqual(bodies, bodies_again)
            self.assertEqual(without_times(history), without_times(again))

    def test_goes_on_on_another_number_of_ranks(self):
        history, _ = self.run_scene("tiles")
        self.run_scene("ranks-2", ranks=2)
        again, _ = self.run_scene("ranks-2", restart="checkpoint-000020.h5")
        assert_close(history, again, FLUID, 1e-8)

    def test_ranks_without_tiles_get_some(self):
        history, _ = self.run_scene("few", steps=6, scene="few")
        other, _ = self.run_scene("few-3", ranks=3, steps=6, scene="few")
        assert_close(history, other, FLUID, 1e-8)

    def test_water_does_not_feel_them(self):
        """Beyond the tiles is air, where p = 0 holds."""
        columns = ("fluid_momentum_x", "fluid_momentum_y", "fluid_kinetic_energy", "liquid_volume")
        history, _ = self.run_scene("dam-all", tiles=False, scene="dam")
        of_tiles, _ = self.run_scene("dam", scene="dam")
        assert_close(history, of_tiles, columns, 1e-6)
        on_two, _ = self.run_scene("dam-2", ranks=2, scene="dam")
        assert_close(history, on_two, columns, 1e-6)
        again, _ = self.run_scene("dam-2", ranks=2, scene="dam", restart="checkpoint-000020.h5")
        self.assertEqual(without_times(on_two), without_times(again))


unittest.main()
