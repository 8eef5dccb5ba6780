"""Bodies that lie, float or are loaded in water at rest stay at rest, with both couplings and in both dimensions; one that nothing
lifts falls freely, and a light one never has more energy than it was let go with. Each scene but the floating boxes broke that while contact did not
know the fluid."""
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from scene_xml import xml  # noqa: E402
from simulation import column, simulate, table  # noqa: E402

G = 9.8


def scene(dimension, solids, coupling, level=.7, dry=(), step=.005, cells=32, gravity=None, **more):
    """A unit tank; vertical is the last axis."""
    fluid = {"Density": 1000., "Gravity": gravity or (0.,) * (dimension - 1) + (-G,)}
    if level:
        fluid["Free Surface"] = {"Liquid": {"Pool": {"Type": "level", "Height": level}}}
    if dry:
        fluid["Free Surface"]["Dry Points"] = dry
    return xml("Scene", {
        "Dimension": dimension, "Domain": {"Lower": (0.,) * dimension, "Upper": (1.,) * dimension, "Cells": (cells,) * dimension},
        "Fluid": fluid, "Solids": solids, "Coupling": {"Type": coupling}, "Solver": {"Tolerance": 1e-10},
        "Contact": {"Tolerance": 1e-9}, "Time": {"End": 100., "Fixed Step": step}, "Output": {"Frames": False}, **more})


def box(size, position, density, **more):
    return {"Type": "rigid body", "Geometry": {"Shape": "box", "Size": size}, "Position": position, "Density": density, **more}


class RestInWater(unittest.TestCase):
    def run_scene(self, text, steps):
        """Histories of bodies and fluid."""
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "scene.xml"
            file.write_text(text)
            simulate(file, Path(folder) / "output", "--steps", steps)
            return table(Path(folder) / "output/bodies.csv"), table(Path(folder) / "output/history.csv")

    def assert_rests(self, text, steps=40):
        """To 1e-4 m/s under flux, where the cells below the rim of a body that touches a wall push a little to the side."""
        bodies, history = self.run_scene(text, steps)
        speed, energy = (1e-4, 1e-7) if "flux" in text else (1e-8, 1e-13)
        for name in [name for name in ("vx", "vy", "vz") if name in bodies[0]]:
            self.assertLess(max(map(abs, column(bodies, name))), speed, name)
        self.assertLess(max(column(history, "fluid_kinetic_energy")), energy)
        self.assertLess(max(column(history, "momentum_error")), 1e-14)

    def test_a_block_lies_on_the_floor(self):
        """It moved at .6 m/s, ratio .5, and at .15 m/s, ratio 2."""
        for density in (500., 2000.):
            for coupling in ("mixed face", "flux"):
                with self.subTest(density=density, coupling=coupling):
                    self.assert_rests(scene(2, {"Block": box((.5, .1), (.5, .05), density)}, coupling))
        self.assert_rests(scene(3, {"Block": box((.5, .5, .1), (.5, .5, .05), 2000.)}, "mixed face", cells=16), steps=20)

    def test_a_lid_lies_on_a_dry_cup(self):
        """It reported 4 m/s while it lay still."""
        solids = {"Cup": {"Type": "rigid body", "Geometry": {"Shape": "open box", "Size": (.4, .3)}, "Position": (.5, .151),
                          "Motion": {"Type": "static"}},
                  "Lid": {"Type": "rigid body", "Geometry": {"Shape": "plate", "Size": (.5, .5), "Normal": "y"},
                          "Surface Density": 1., "Position": (.5, .304)}}
        for coupling in ("mixed face", "flux"):
            with self.subTest(coupling=coupling):
                self.assert_rests(scene(2, solids, coupling, dry=(.5, .1)))

    def test_bodies_float_at_their_draft(self):
        """Upright, a box; turned, a square log of half the density of water, which lies with a corner down under tilted gravity."""
        for coupling in ("mixed face", "flux"):
            with self.subTest(coupling=coupling):
                self.assert_rests(scene(2, {"Box": box((.4, .2), (.517, .7 + .1 - .2 * .3), 300.)}, coupling))
        self.assert_rests(scene(3, {"Box": box((.4, .4, .2), (.517, .48, .7 + .1 - .2 * .3), 300.)}, "mixed face", cells=16), steps=20)

    def test_a_loaded_raft_floats(self):
        """The load lies free on it. Both sank to the floor within a second."""
        raft = {**box((.6, .1), (.5, .7 + .05 - 26 / 600), 1.), "Mass": 6., "Friction": .5}
        load = {**box((.15, .15), (.5, .7 + .1 - 26 / 600 + .075), 1.), "Mass": 20., "Friction": .5}
        for solid in (raft, load):
            del solid["Density"]
        text = scene(2, {"Raft": raft, "Load": load}, "mixed face", step=.01)
        self.assert_rests(text, steps=100)
        density = 'name="Density" type="double" value="1000.0"/>'
        viscous = text.replace(density, density + '<Parameter name="Viscosity" type="double" value="0.5"/>', 1)
        for kind, scene_text, speed in (("viscous", viscous, 1e-5),
                                        ("flux", scene(2, {"Raft": raft, "Load": load}, "flux", step=.01), 2e-3)):
            with self.subTest(kind):  # flux: cells of the waterline whose centres lie in the raft are not at rest
                bodies, _ = self.run_scene(scene_text, 100)
                self.assertLess(max(map(abs, column(bodies, "vy"))), speed)

    def test_a_light_ball_gains_no_energy(self):
        """It floats, nearly weightless, beside a wall: its bumps against it, at "-.9 m/s", gave it 170 J of 30."""
        for coupling in ("mixed face", "flux"):
            with self.subTest(coupling=coupling):
                ball = {"Type": "rigid body", "Geometry": {"Shape": "ball", "Radius": .15}, "Position": (.45, .52), "Density": 1.}
                bodies, history = self.run_scene(scene(2, {"Ball": ball}, coupling, level=.5, step=.02, cells=24), 150)
                self.assertGreater(max(column(bodies, "y")), .58)  # it was let go too deep
                self.assertLess(max(column(history, "fluid_kinetic_energy")), 30)

    def test_nothing_lifts_a_pile_through_floor_and_lid(self):
        """It has twice the density of the fluid, and fell with half of gravity."""
        pile = {**box((.25, 3.), (.5, .5), 1.), "Mass": 500., "Locked": ("x", "rotation")}
        del pile["Density"]
        for coupling in ("mixed face",):
            with self.subTest(coupling=coupling):
                bodies, _ = self.run_scene(scene(2, {"Pile": pile}, coupling, level=None, step=.01, cells=16, Contact={"Type": "none"}), 1)
                self.assertAlmostEqual(float(bodies[-1]["vy"]), -G * .01, delta=1e-9)


unittest.main()
