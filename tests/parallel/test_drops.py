"""Spray of a wave that breaks over a post, among a ball afloat, a raft that falls and a shelf: drops have their part of volume and
momentum, both balanced to round-off; the same on any number of ranks, and continued from a checkpoint bit for bit."""
import shutil
import sys
import tempfile
import unittest
from pathlib import Path

import h5py
import numpy

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from scene_xml import xml  # noqa: E402
sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "errors"))
from program import with_checksum, without_checksum  # noqa: E402
sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools"))
from lockstep_frames import read_frames  # noqa: E402
from simulation import STATE, assert_close, column, simulate, table, without_times  # noqa: E402

N_STEPS = 60
SIDES = {f"{axis} {end}": {"Type": "slip wall"} for axis in "xy" for end in ("lower", "upper")}


def scene(drops, moving_tiles=False):
    surface = {"Interface": {"Type": "particle level set", "Drops": drops},
               "Liquid": {"Column": {"Type": "box", "Lower": (-1., -1.), "Upper": (.5, .6)},
                          "Pool": {"Type": "level", "Height": .14}},
               "Watch": {"Tank": {"Point": (.2, .1)}}}
    solids = {
        "Post": {"Type": "rigid body", "Geometry": {"Shape": "box", "Size": (.1, .2)}, "Position": (.9, .1),
                 "Motion": {"Type": "static"}},
        "Shelf": {"Type": "rigid body", "Geometry": {"Shape": "plate", "Size": (.3, 0.), "Normal": "y"},
                  "Position": (1.4, .42), "Motion": {"Type": "static"}},
        "Raft": {"Type": "rigid body", "Geometry": {"Shape": "plate", "Size": (.3, 0.), "Normal": "y"}, "Surface Density": 8.,
                 "Position": (1.1, .9)},
        "Ball": {"Type": "rigid body", "Geometry": {"Shape": "ball", "Radius": .09}, "Density": 300.,
                 "Position": (1.3, .17)}}
    fluid = {"Density": 1000., "Gravity": (0., -9.8), "Free Surface": surface}
    if moving_tiles:
        fluid["Moving Tiles"] = {}
    return xml("Scene", {
        "Dimension": 2, "Domain": {"Lower": (0., 0.), "Upper": (1.6, 1.), "Cells": (48, 30), "Sides": SIDES},
        "Fluid": fluid, "Solids": solids, "Contact": {"Type": "none"}, "Solver": {"Tolerance": 1e-11},
        "Time": {"End": 10., "Fixed Step": .01}, "Output": {"Checkpoints": {"Interval": .35, "Count": 9}, "Precision": "double"}})


def run(file, output, steps, ranks=1, restart=()):
    simulate(file, output, "--steps", steps, *restart, ranks=ranks)
    return without_times(table(output / "history.csv")), table(output / "bodies.csv")


def put_drop(checkpoint, numbers):
    """Writes drops into a checkpoint: ranks, then rank, place, velocity, volume of each."""
    checkpoint.write_bytes(without_checksum(checkpoint.read_bytes()))
    with h5py.File(checkpoint, "a") as file:
        del file["fluid/drops"]
        file["fluid/drops"] = numpy.array(numbers, float)
    checkpoint.write_bytes(with_checksum(checkpoint.read_bytes()))


class Drops(unittest.TestCase):
    def test_ledgers_ranks_and_restart(self):
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "scene.xml"
            file.write_text(scene("ballistic"))
            runs = {ranks: run(file, Path(folder) / str(ranks), N_STEPS, ranks) for ranks in (1, 2, 4)}
            for history, bodies in runs.values():
                self.check_ledgers(history)
                assert_close(runs[1][1], bodies, STATE, 1e-6)
                assert_close(runs[1][0], history, ("liquid_volume", "fluid_kinetic_energy", "drops_volume"), 1e-6)
            self.check_fall(Path(folder) / "1")
            self.check_restart(file, Path(folder) / "2", runs[2], 2)

    def check_fall(self, output):
        """From frame to frame, most drops go the way of stones."""
        n_fallen, n_all, earlier = 0, 0, None
        for frame in read_frames(output):
            drops = frame["drops"] if "drops" in frame.names else None
            now = (drops.points()[:, :2], drops.values("velocity")[:, :2]) if drops and len(drops.points()) else None
            if now and earlier:
                fall = numpy.array([0, -9.8])
                places = earlier[0] + .01 * earlier[1] + .5 * .01**2 * fall
                speeds = earlier[1] + .01 * fall
                for place, speed in zip(places, speeds):
                    n_all += 1
                    n_fallen += numpy.min(numpy.abs(now[0] - place).max(1) + numpy.abs(now[1] - speed).max(1)) < 1e-9
            earlier = now
        self.assertGreater(n_all, 200)
        self.assertGreater(n_fallen, .5 * n_all)

    def test_moving_tiles(self):
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "scene.xml"
            file.write_text(scene("ballistic", moving_tiles=True))
            tiles = run(file, Path(folder) / "tiles", N_STEPS)
            self.check_ledgers(tiles[0])
            self.check_restart(file, Path(folder) / "tiles", tiles, 1)

    def check_restart(self, file, output, whole, ranks):
        again = Path(shutil.copytree(output, f"{output}-again"))
        middle = sorted(again.glob("checkpoint-*.h5"))[0]
        self.assertEqual(run(file, again, N_STEPS, ranks, ("--restart", middle)), whole)

    def check_ledgers(self, history):
        self.assertEqual(len(history), N_STEPS)
        for name in ("momentum_error", "angular_momentum_error"):
            self.assertLess(max(column(history, name)), 1e-12, name)
        self.assertGreater(max(column(history, "drops")), 20)
        # The raft comes down on some, which then have no room.
        self.assertLess(max(column(history, "lost_volume")), .002)
        columns = [column(history, name) for name in ("liquid_volume_target", "drops_volume", "lost_volume")]
        whole = [sum(parts) for parts in zip(*columns)]
        self.assertLess(max(whole) - min(whole), 1e-13 * whole[0])

    def test_what_falls_into_water_moves_it(self):
        """One drop above a pool at rest, periodic along x: all of its momentum along x ends in the water."""
        sides = {f"x {end}": {"Type": "periodic"} for end in ("lower", "upper")}
        pool = xml("Scene", {
            "Dimension": 2, "Domain": {"Upper": (1.6, 1.), "Cells": (48, 30), "Sides": sides},
            "Fluid": {"Density": 1000., "Gravity": (0., -9.8), "Free Surface": {
                "Interface": {"Type": "particle level set", "Drops": "ballistic"}, "Liquid": {"Pool": {"Type": "level", "Height": .34}}}},
            "Solver": {"Tolerance": 1e-12}, "Output": {"Checkpoints": {"Interval": .01}},
            "Time": {"End": 10., "Fixed Step": .01}})
        volume = 3e-5
        for ranks in 1, 2:
            with self.subTest(ranks=ranks), tempfile.TemporaryDirectory() as folder:
                file, output = Path(folder) / "scene.xml", Path(folder) / "output"
                file.write_text(pool)
                run(file, output, 1, ranks)
                checkpoint = sorted(output.glob("checkpoint-*.h5"))[-1]
                put_drop(checkpoint, [ranks, 0, .5, .36, 1, 0, volume])
                history, _ = run(file, output, 12, ranks, ("--restart", checkpoint))
                drops = column(history, "drops")
                self.assertEqual((drops[1], drops[-1]), (1, 0))
                # To the step that takes it in; what is water then is advected, which does not conserve.
                taken = drops.index(0, 1)
                for momentum in column(history, "fluid_momentum_x")[1 : taken + 1]:
                    self.assertLess(abs(momentum - 1000 * volume), 1e-12 * 1000 * volume)

    def test_what_falls_on_a_plate_pushes_it_once(self):
        """A plate that may slide along x takes from a drop what the drop loses, with both orders in time; periodic along x, above a pool."""
        sides = {f"x {end}": {"Type": "periodic"} for end in ("lower", "upper")}
        plate = {"Type": "rigid body", "Geometry": {"Shape": "plate", "Size": (0., .3), "Normal": "x"}, "Surface Density": 8., "Position": (.8, .6),
                 "Locked": ("y", "rotation")}
        volume = 3e-5
        for order in 1, 2:
            with self.subTest(order=order), tempfile.TemporaryDirectory() as folder:
                file, output = Path(folder) / "scene.xml", Path(folder) / "output"
                file.write_text(xml("Scene", {
                    "Dimension": 2, "Domain": {"Upper": (1.6, 1.), "Cells": (48, 30), "Sides": sides},
                    "Fluid": {"Density": 1000., "Gravity": (0., -9.8), "Free Surface": {
                        "Interface": {"Type": "particle level set", "Drops": "ballistic"}, "Liquid": {"Pool": {"Type": "level", "Height": .2}}}},
                    "Solids": {"Plate": plate}, "Contact": {"Type": "none"}, "Solver": {"Tolerance": 1e-12},
                    "Output": {"Checkpoints": {"Interval": .01}}, "Time": {"End": 10., "Fixed Step": .01, "Order in Time": order}}))
                run(file, output, 1)
                checkpoint = sorted(output.glob("checkpoint-*.h5"))[-1]
                put_drop(checkpoint, [1, 0, .77, .65, 1, 0, volume])
                history, _ = run(file, output, 8, 1, ("--restart", checkpoint))
                for of_drop, of_plate in zip(column(history, "fluid_momentum_x")[1:], column(history, "solid_momentum_x")[1:]):
                    self.assertLess(abs(of_drop + of_plate - 1000 * volume), 1e-12 * 1000 * volume)
                self.assertAlmostEqual(of_plate / (1000 * volume), 1, delta=1e-12)

    def test_without_drops_nothing_is_told_of_them(self):
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "scene.xml"
            file.write_text(scene("none"))
            history, _ = run(file, Path(folder) / "none", 2)
            self.assertNotIn("drops", history[0])


if __name__ == "__main__":
    unittest.main()
