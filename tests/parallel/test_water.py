"""Water with a floating ball, a boat that must stay dry and a jet: momentum balanced to round-off, the same on any number
of ranks, and continued from a checkpoint bit for bit, with each interface model and both couplings, and with surface tension that is implicit."""
import shutil
import sys
import tempfile
import unittest
from pathlib import Path

import h5py

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from scene_xml import xml  # noqa: E402
from simulation import FLUID, STATE, assert_close, simulate, table, without_times  # noqa: E402


def scene(dimension, interface, coupling, tension):
    def point(x, y, z=.5):
        return (x, y) if dimension == 2 else (x, y, z)

    jet = {"Shape": "box", "Lower": point(.22, .12, .4), "Upper": point(.42, .42, .6), "Liquid": True,
           "Velocity": point(.3, 2.5, .1)}
    surface = {"Interface": {"Type": interface}, "Liquid": {"Pool": {"Type": "level", "Height": .6}},
               "Dry Points": point(1.3, .55), "Watch": {"Inside": {"Point": point(1.3, .55), "Solid": "Boat",
                                                                   "Radius": .15}},
               "Surface Tension": tension, "Time Integration": "semi-implicit"}
    solids = {
        "Boat": {"Type": "rigid body", "Geometry": {"Shape": "open box", "Size": (.5, .4, .4)[:dimension]},
                 "Surface Density": 25., "Position": point(1.3, .6, .47)},
        "Ball": {"Type": "rigid body", "Geometry": {"Shape": "ball", "Radius": .13}, "Density": 400.,
                 "Position": point(.75, .6)}}
    return xml("Scene", {
        "Dimension": dimension,
        "Domain": {"Lower": (0., 0., 0.)[:dimension], "Upper": point(1.8, 1.2, 1.),
                   "Cells": (54, 36) if dimension == 2 else (27, 18, 15)},
        "Fluid": {"Density": 1000., "Gravity": point(0., -9.8, 0.), "Sources": {"Jet": jet}, "Free Surface": surface},
        "Solids": solids, "Coupling": {"Type": coupling}, "Contact": {"Type": "none"}, "Solver": {"Tolerance": 1e-11},
        "Time": {"End": 10., "Fixed Step": .01}, "Output": {"Checkpoints": {"Interval": .1, "Count": 9}}})


def duct(interface):
    """Full of water that flows in on one side and out on the other, half of which posts cover, in cells with centres on both
    sides of their faces."""
    def post(y, height):
        return {"Type": "rigid body", "Geometry": {"Shape": "box", "Size": (.37, height)}, "Position": (1., y),
                "Motion": {"Type": "static"}}

    return xml("Scene", {
        "Dimension": 2,
        "Domain": {"Lower": (0., 0.), "Upper": (1., .5), "Cells": (32, 16), "Sides": {
            "x lower": {"Type": "inflow", "Velocity": (.2, 0.)}, "x upper": {"Type": "open"}}},
        "Fluid": {"Density": 1000., "Free Surface": {
            "Interface": {"Type": interface},
            "Liquid": {"All": {"Type": "box", "Lower": (-1., -1.), "Upper": (2., 2.)}}}},
        "Solids": {"Low": post(0., .394), "High": post(.5, .3)}, "Coupling": {"Type": "flux"},
        "Solver": {"Tolerance": 1e-12}, "Time": {"End": 10., "Fixed Step": .01}})


def faucet(interface):
    """A tank that is empty until a source lets water in, above a ball."""
    tap = {"Shape": "box", "Lower": (.4, .6), "Upper": (.6, .7), "Liquid": True, "Velocity": (.1, -1.)}
    ball = {"Type": "rigid body", "Geometry": {"Shape": "ball", "Radius": .15}, "Density": 400., "Position": (.5, .2)}
    return xml("Scene", {
        "Dimension": 2, "Domain": {"Lower": (0., 0.), "Upper": (1., 1.), "Cells": (32, 32)},
        "Fluid": {"Density": 1000., "Gravity": (0., -9.8), "Sources": {"Tap": tap}, "Free Surface": {"Interface": {"Type": interface}}},
        "Solids": {"Ball": ball}, "Solver": {"Tolerance": 1e-12}, "Time": {"End": 10., "Fixed Step": .01}})


def run(file, output, steps, ranks=1, restart=()):
    simulate(file, output, "--steps", steps, *restart, ranks=ranks, audited=True)
    return without_times(table(output / "history.csv")), table(output / "bodies.csv")


class Faucet(unittest.TestCase):
    def test_an_empty_tank_is_filled(self):
        for interface in ("particle level set", "volume of fluid"):
            with self.subTest(interface=interface), tempfile.TemporaryDirectory() as folder:
                file = Path(folder) / "scene.xml"
                file.write_text(faucet(interface))
                runs = {ranks: run(file, Path(folder) / str(ranks), 20, ranks) for ranks in (1, 2)}
                # the source's content, and the flow out of its shape at 1 m/s and faster in .2 s
                self.assertGreater(float(runs[1][0][-1]["liquid_volume"]), .02 + .8 * .2 * .2)
                for history, bodies in runs.values():
                    for row in history:
                        self.assertLessEqual(float(row["momentum_error"]), 1e-10)
                        self.assertAlmostEqual(float(row["liquid_volume"]) / float(row["liquid_volume_target"]), 1, delta=.02)  # a thin jet
                    assert_close(runs[1][1], bodies, STATE, 1e-7)


class DropInGas(unittest.TestCase):
    def test_a_drop_that_tension_bends_is_the_same_on_any_ranks(self):
        """A box of liquid that lies askew over tiles; its curvature is that of columns, which reach over the borders of ranks."""
        box = {"Type": "box", "Lower": (.27, .3), "Upper": (.71, .66)}
        text = xml("Scene", {
            "Dimension": 2, "Domain": {"Cells": (48, 48)},
            "Fluid": {"Density": 1000., "Viscosity": 1., "Phases": {"Gas": {"Density": 1., "Viscosity": .01}}, "Free Surface": {
                "Interface": {"Type": "volume of fluid"}, "Surface Tension": 100., "Liquid": {"Drop": box}}},
            "Solver": {"Tolerance": 1e-11}, "Time": {"End": 10., "Fixed Step": .002},
            "Output": {"Frames": False, "Checkpoints": {"Interval": .008, "Count": 9}}})
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            file = folder / "scene.xml"
            file.write_text(text)
            runs = {}
            for ranks in (1, 2, 3):
                simulate(file, folder / str(ranks), "--steps", 12, ranks=ranks)
                runs[ranks] = without_times(table(folder / str(ranks) / "history.csv"))
                assert_close(runs[1], runs[ranks], ("fluid_kinetic_energy", "liquid_volume"), 1e-12)
            again = shutil.copytree(folder / "2", folder / "again")
            simulate(file, again, "--steps", 12, "--restart", sorted(again.glob("checkpoint-*.h5"))[0], ranks=2)
            self.assertEqual(without_times(table(again / "history.csv")), runs[2])


class Shares(unittest.TestCase):
    def test_each_rank_has_its_part_of_the_water(self):
        """A high tank with a little on its floor, in 4 by 16 tiles, of which 4 by 4 are wet."""
        tank = xml("Scene", {
            "Dimension": 2, "Domain": {"Lower": (0., 0.), "Upper": (1., 4.), "Cells": (64, 256)},
            "Fluid": {"Density": 1000., "Gravity": (0., -9.8), "Free Surface": {
                "Liquid": {"Pool": {"Type": "level", "Height": 1.}}}},
            "Time": {"End": 10., "Fixed Step": .01}})
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "scene.xml"
            file.write_text(tank)
            simulate(file, Path(folder) / "run", "--steps", 2, ranks=2)
            with h5py.File(Path(folder) / "run/checkpoint-000002.h5") as checkpoint:
                tiles, owners = (checkpoint["fluid/tiles"][name][:] for name in ("ids", "values"))
        for rank in range(2):
            n_wet = sum(tile < 16 and owner == rank for tile, owner in zip(tiles, owners))
            self.assertGreaterEqual(n_wet, 5, f"rank {rank}")  # even if it has no dry ones


class Water(unittest.TestCase):
    def check(self, dimension, interface, coupling, steps, tension=0.):
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "scene.xml"
            file.write_text(scene(dimension, interface, coupling, tension))
            runs = {ranks: run(file, Path(folder) / str(ranks), steps, ranks) for ranks in (1, 2, 4)}
            for history, bodies in runs.values():
                self.assertEqual(len(history), steps)
                for row in history:
                    for column in ("momentum_error", "angular_momentum_error"):
                        self.assertLessEqual(float(row[column]), 1e-10, column)
                assert_close(runs[1][1], bodies, STATE, 1e-7)
                assert_close(runs[1][0], history, FLUID, 1e-7)
            middles = [path.name for path in sorted((Path(folder) / "2").glob("checkpoint-*.h5")) if f"{steps:06}" not in path.name]
            for middle in middles:
                again = shutil.copytree(Path(folder) / "2", Path(folder) / f"again from {middle}")
                self.assertEqual(run(file, again, steps, 2, ("--restart", again / middle)), runs[2])
            self.check_idle_restart(file, Path(folder), middles[0], runs[2])

    def check_idle_restart(self, file, folder, checkpoint, whole):
        """A run that has nothing left to do writes a checkpoint that others go on from."""
        idle = Path(shutil.copytree(folder / "2", folder / "idle"))
        at = int(checkpoint.split("-")[1].split(".")[0])
        run(file, idle, at, 2, ("--restart", idle / checkpoint))
        self.assertEqual(run(file, idle, len(whole[0]), 2, ("--restart", idle / checkpoint)), whole)

    def test_openings(self):
        """The inflow equals the outflow."""
        for interface in ("level set", "volume of fluid"):
            with tempfile.TemporaryDirectory() as folder:
                file = Path(folder) / "scene.xml"
                file.write_text(duct(interface))
                for ranks in (1, 2):
                    targets = [float(row["liquid_volume_target"]) for row in run(file, Path(folder) / str(ranks), 10, ranks)[0]]
                    self.assertLess(max(targets) - min(targets), 1e-9, interface)

    def test_particles(self):
        self.check(2, "particle level set", "mixed face", 20)

    def test_level_set_with_fluxes(self):
        self.check(2, "level set", "flux", 24)  # ranks share their work anew before step 21

    def test_volumes(self):
        self.check(2, "volume of fluid", "mixed face", 20)

    def test_implicit_tension(self):
        # .01 s is 1.9 times what explicit tension bears.
        self.check(2, "level set", "mixed face", 20, 100.)

    def test_in_space(self):
        self.check(3, "particle level set", "flux", 12)


if __name__ == "__main__":
    unittest.main()
