"""Bodies that lie, float or are loaded in water at rest stay at rest, with both couplings and in both dimensions; one that nothing
lifts falls freely, and a light one never has more energy than it was let go with. Each scene but the floating boxes broke that while contact did not
know the fluid."""
import math
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


def viscous(text):
    density = 'name="Density" type="double" value="1000.0"/>'
    return text.replace(density, density + '<Parameter name="Viscosity" type="double" value="0.5"/>', 1)


def box(size, position, density, **more):
    return {"Type": "rigid body", "Geometry": {"Shape": "box", "Size": size}, "Position": position, "Density": density, **more}


class RestInWater(unittest.TestCase):
    def run_scene(self, text, steps, ranks=1):
        """Histories of bodies and fluid."""
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "scene.xml"
            file.write_text(text)
            simulate(file, Path(folder) / "output", "--steps", steps, ranks=ranks)
            return table(Path(folder) / "output/bodies.csv"), table(Path(folder) / "output/history.csv")

    def assert_rests(self, text, steps=40):
        """To 1e-4 m/s under flux, where the cells below the rim of a body that touches a wall push a little to the side."""
        bodies, history = self.run_scene(text, steps)
        speed, energy = (1e-4, 1e-7) if "flux" in text else (1e-8, 1e-13)
        for name in [name for name in ("vx", "vy", "vz") if name in bodies[0]]:
            self.assertLess(max(map(abs, column(bodies, name))), speed, name)
        self.assertLess(max(column(history, "fluid_kinetic_energy")), energy)
        self.assertLess(max(column(history, "momentum_error")), 1e-14)
        return bodies

    def test_a_light_body_leaves_the_floor(self):
        """A disc of half the density of water starts with .179 g beside a floor (added mass pi^2 / 3 - 1); it stuck. What rises drains
        the patch below it, in a full tank as well."""
        disc = {"Type": "rigid body", "Geometry": {"Shape": "ball", "Radius": .2}, "Position": (.5, .2), "Density": 500.}
        for level in (.8, None):
            with self.subTest(level=level):
                bodies, history = self.run_scene(scene(2, {"Disc": disc}, "mixed face", level=level, step=.01, cells=48), 1)
                self.assertAlmostEqual(float(bodies[-1]["vy"]) / (.01 * G), .179, delta=.03)
                self.assertLess(max(column(history, "momentum_error")), 1e-14)

    def test_what_comes_near_the_floor_lands(self):
        """A disc of twice the density of water came to rest a third of a cell above the floor, without contact, and hovered."""
        disc = {"Type": "rigid body", "Geometry": {"Shape": "ball", "Radius": .1}, "Position": (.5, .15), "Density": 2000.,
                "Restitution": 0.}
        bodies, _ = self.run_scene(scene(2, {"Disc": disc}, "mixed face", step=.01, cells=20), 100)
        self.assertAlmostEqual(float(bodies[-1]["y"]), .1, delta=1e-3)
        self.assertLess(abs(float(bodies[-1]["vy"])), 1e-6)

    def test_links_close_to_each_other_turn_in_a_full_tank(self):
        """The elbow of two links 5 mm apart stood still, held by faces that both share, and turned by 2.3 rad in one step later."""
        solids = {"Arm": box((.06, .3), (1., .95), 2000.), "Blade": box((.06, .25), (1., .67), 1200.)}
        joints = {"Motor": {"Type": "hinge", "Solids": ("space", "Arm"), "Point": (1., 1.1), "Control": "prescribed",
                            "Target": {"Type": "table", "Times": (0., 10.), "Values": (0., 30.)}},
                  "Elbow": {"Type": "hinge", "Solids": ("Arm", "Blade"), "Point": (1., .8), "Control": "proportional derivative",
                            "Natural Frequency": 10.}}
        text = scene(2, solids, "mixed face", level=None, step=.02, cells=64, Joints=joints)
        text = text.replace('name="Upper" type="Array(double)" value="{1.0, 1.0}"', 'name="Upper" type="Array(double)" value="{2.0, 2.0}"')
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "scene.xml"
            file.write_text(text)
            simulate(file, Path(folder) / "output", "--steps", 1)
            rate = [float(row["rate"]) for row in table(Path(folder) / "output/joints.csv") if row["name"] == "Elbow"]
        self.assertAlmostEqual(rate[0], -9.5, delta=1)

    def test_a_block_lies_on_the_floor(self):
        """It moved at .15 m/s. The floor bears what water does not."""
        for coupling in ("mixed face", "flux"):
            with self.subTest(coupling=coupling):
                bodies = self.assert_rests(scene(2, {"Block": box((.5, .1), (.5, .05), 2000.)}, coupling))
                weight = .05 * 1000. * G
                self.assertAlmostEqual(float(bodies[-1]["fy"]), weight, delta=1e-6 * weight)
                self.assertAlmostEqual(float(bodies[-1]["contact_fy"]), weight, delta=1e-6 * weight)
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

    def assert_still(self, text, steps=40):
        """Below 1e-6 of the speed of long waves in the tank, sqrt(g L), once what is soft has taken up its weight; and so is the water."""
        bodies, history = self.run_scene(text, steps)
        settled = [row for row in bodies if int(row["step"]) > steps // 4]
        self.assertLess(max(abs(v) for name in ("vx", "vy") for v in column(settled, name)), 1e-6 * G**.5)
        self.assertLess(max(column(history[steps // 4:], "fluid_kinetic_energy")), 1e-6)
        self.assertLess(max(column(history, "momentum_error")), 1e-13)

    def test_links_lie_on_the_floor(self):
        """A viscous fluid did not know of their contact, and stirred them at 1e-4 m/s. So it did a flap that lies at its limit."""
        links = {"A": box((.2, .1), (.35, .05), 2000., Friction=.5), "B": box((.2, .1), (.6, .05), 2000., Friction=.5)}
        pin = {"Pin": {"Type": "hinge", "Solids": ("A", "B"), "Point": (.475, .05)}}
        flap = {"Flap": box((.4, .06), (.5, .3), 2000.)}
        stop = {"Pin": {"Type": "hinge", "Solids": ("space", "Flap"), "Point": (.28, .3), "Limits": {"Lower": 0., "Upper": 1.}}}
        for name, solids, joints in (("links", links, pin), ("flap", flap, stop)):
            with self.subTest(name):
                self.assert_still(viscous(scene(2, solids, "mixed face", Joints=joints)))

    def test_links_lie_over_a_stone(self):
        """Two rafters, joined at the ridge, lean on a ball between them, which pinches off the water below it. Beside such water contact with
        joints acted before and after the coupled solve: with flux and the paper's step the roof shook at 8 mm/s for ever."""
        radius, thickness, slope = .12, .04, math.sqrt(.5)
        ridge = radius + radius / slope  # height of the undersides, which touch the ball at 45 degrees
        rafters = {name: box((ridge / slope, thickness), (.5 + side * (ridge + thickness * slope) / 2, (ridge + thickness * slope) / 2), 2000.,
                             Rotation=-side * math.pi / 4, Friction=.5) for name, side in (("Left", -1), ("Right", 1))}
        stone = {"Type": "rigid body", "Geometry": {"Shape": "ball", "Radius": radius}, "Position": (.5, radius), "Density": 2500., "Friction": .5}
        joint = {"Ridge": {"Type": "hinge", "Solids": ("Left", "Right"), "Point": (.5, ridge + thickness * slope)}}
        weight = 1000 * G * 2 * thickness * ridge / slope
        for coupling, level, order, ranks in (("mixed face", None, 2, 1), ("flux", .7, 2, 2), ("flux", None, 1, 1)):
            with self.subTest(coupling=coupling, level=level, order=order, ranks=ranks):
                time = {"End": 100., "Fixed Step": .005, "Order in Time": order}
                bodies, history = self.run_scene(scene(2, {**rafters, "Stone": stone}, coupling, level=level, Joints=joint, Time=time), 40, ranks)
                self.assertLess(max(abs(v) for name in ("vx", "vy", "wz") for v in column(bodies, name)), 1e-6 * G**.5)
                self.assertLess(max(column(history, "momentum_error")), 1e-14)
                self.assertEqual(max(column(history, "contacts_outside")), 0)
                feet = sum(float(row["contact_fy"]) for row in bodies[-3:] if row["name"] != "Stone")
                if order == 2:  # else the ball bears some of it
                    self.assertAlmostEqual(feet / weight, 1, delta=.01)  # its weight in water

    def test_links_fall_over_a_stone(self):
        """Between them, the ball and the floor is water of its own, now and then. Contact acted outside of 460 of 600 solves."""
        links = {name: box((.15, .05), (.3 + .17 * k, .4), 2000., Friction=.5) for k, name in enumerate("ABC")}
        stone = {"Type": "rigid body", "Geometry": {"Shape": "ball", "Radius": .12}, "Position": (.5, .121), "Density": 2500., "Friction": .5}
        joints = {a + b: {"Type": "hinge", "Solids": (a, b), "Point": (x, .4)} for a, b, x in (("A", "B", .385), ("B", "C", .555))}
        for level in (.7, None):
            with self.subTest(level=level):
                bodies, history = self.run_scene(scene(2, {**links, "Stone": stone}, "mixed face", level=level, step=.01, Joints=joints), 300)
                self.assertLess(sum(column(history, "contacts_outside")), 60)
                self.assertLess(max(column(history, "momentum_error")), 1e-13)
                self.assertLess(max(column(history, "deepest_overlap")), 1e-3)

    def test_soft_solids_lie_on_the_floor(self):
        """A sheet on a box reported .46 m/s while it lay still; a stiff block crept, and ever faster."""
        skin = .05 / 32  # half a thickness
        sheet = {"Type": "cloth", "Surface Density": 30., "Young's Modulus": 1e5, "Thickness": .01, "Friction": .5,
                 "Geometry": {"Shape": "sheet", "Size": (.3, .3), "Normal": "y"}, "Position": (.5, .1 + skin)}
        block = {"Type": "deformable body", "Density": 2000., "Friction": .5, "Material": {"Young's Modulus": 1e9},
                 "Geometry": {"Shape": "box", "Size": (.5, .1), "Mesh Spacing": .05}, "Position": (.5, .05 + skin)}
        below = box((.5, .1), (.5, .05), 2000., Friction=.5)
        lying = scene(2, {"Block": block}, "mixed face")
        for name, text in (("sheet", scene(2, {"Box": below, "Sheet": sheet}, "mixed face")), ("block", lying), ("viscous", viscous(lying))):
            with self.subTest(name):
                self.assert_still(text)

    def test_a_stone_lies_on_a_cushion_in_a_full_tank(self):
        """Closed fluid locks what is soft. There contact acted before and after the coupled solve: the stone went up and down at 15 mm/s for ever.
        Forces of first order damp what a drop from rest stirs, which of second order goes on at .4 mm/s after 2 s."""
        cushion = {"Type": "deformable body", "Geometry": {"Shape": "box", "Size": (.5, .2), "Mesh Spacing": .04}, "Position": (.5, .1),
                   "Material": {"Type": "corotated", "Young's Modulus": 1e5, "Poisson's Ratio": .3}, "Density": 1500., "Viscosity": 100.,
                   "Friction": .3, "Time Integration": "fully-implicit"}
        solids = {"Cushion": cushion, "Stone": box((.2, .15), (.5, .28), 2500., Friction=.3)}
        for coupling in ("mixed face", "flux"):
            with self.subTest(coupling=coupling):
                bodies, history = self.run_scene(viscous(scene(2, solids, coupling, level=None, step=.01)), 200)
                end = [row for row in bodies if row["time"] == bodies[-1]["time"]]
                self.assertLess(max(abs(float(row[name])) for row in end for name in ("vx", "vy")), 1e-4)
                self.assertLess(float(history[-1]["fluid_kinetic_energy"]), 1e-3)
                self.assertLess(max(column(history, "momentum_error")), 1e-14)
                self.assertLess(max(column(history, "contact_residual")), 1e-3 * G * .01)
                self.assertLessEqual(max(column(history[-10:], "contact_solves")), 2)  # one a phase
                stone = next(row for row in end if row["name"] == "Stone")
                self.assertAlmostEqual(float(stone["contact_fy"]) / (1500 * G * .2 * .15), 1, delta=1e-3)  # its weight in water

    def test_stones_lie_in_a_pyramid(self):
        """They pinch off the water between them and the floor, which then locks some of what contacts hold. There contact acted before and
        after the coupled solve: stones crept and the water went on to move, both at some 1e-4 m/s."""
        radius = .15
        stone = {"Type": "rigid body", "Geometry": {"Shape": "ball", "Radius": radius}, "Density": 2500., "Friction": .5}
        places = {"Left": (.5 - radius, radius), "Right": (.5 + radius, radius), "Top": (.5, radius * (1 + 3**.5))}
        solids = {name: {**stone, "Position": place} for name, place in places.items()}
        for coupling in ("mixed face", "flux"):
            with self.subTest(coupling=coupling):
                bodies, history = self.run_scene(scene(2, solids, coupling, level=.9), 60)
                settled = [row for row in bodies if int(row["step"]) > 15]
                self.assertLess(max(abs(v) for name in ("vx", "vy", "wz") for v in column(settled, name)), 1e-6 * G**.5)
                self.assertLess(max(column(history, "momentum_error")), 1e-14)
                self.assertTrue(all(0 < n <= 4 for n in column(history[-10:], "contact_solves")))
                self.assertEqual(max(column(history[-10:], "contacts_outside")), 0)
                # Whoever bears a load, contact or the water that is locked, there is no more than that of all.
                load = 3 * 1500 * G * math.pi * radius**2
                self.assertLess(max(abs(v) for name in ("contact_fx", "contact_fy") for v in column(bodies, name)), load)

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
        for kind, scene_text, speed in (("viscous", viscous(text), 1e-5),
                                        ("flux", scene(2, {"Raft": raft, "Load": load}, "flux", step=.01), 2e-3)):
            with self.subTest(kind):  # flux: cells of the waterline whose centres lie in the raft are not at rest
                bodies, _ = self.run_scene(scene_text, 100)
                self.assertLess(max(map(abs, column(bodies, "vy"))), speed)

    def test_a_light_ball_gains_no_energy(self):
        """It floats, nearly weightless, beside a wall: its bumps against it, at "-.9 m/s", gave it 170 J of 30."""
        for coupling, tolerance in (("mixed face", 1e-10), ("automatic", 1e-10), ("automatic", 1e-8)):
            with self.subTest(coupling=coupling, tolerance=tolerance):
                bodies, history = self.run_scene(self.light_ball(coupling, .45, tolerance), 150)
                self.assertGreater(min(column(bodies, "x")), .149)  # it went half through the wall
                self.assertGreater(max(column(bodies, "y")), .58)  # it was let go too deep
                self.assertLess(max(column(history, "fluid_kinetic_energy")), 30)

    def test_a_light_ball_is_not_turned(self):
        """Fluxes hold the spin of a disc by its own inertia alone. Half of the torque of water at rest, that of vertical forces, was taken off
        alone where the water was uneven: these three turned at 188, 2600 and 230 rad/s, and had 218, 5200 and 357 J of 8."""
        for place in (.456, .459, .46):
            with self.subTest(place=place):
                bodies, history = self.run_scene(self.light_ball("flux", place), 150)
                self.assertLess(max(map(abs, column(bodies, "wz"))), 20)
                self.assertLess(max(column(history, "fluid_kinetic_energy")), 12)

    @staticmethod
    def light_ball(coupling, place, tolerance=1e-10):
        ball = {"Type": "rigid body", "Geometry": {"Shape": "ball", "Radius": .15}, "Position": (place, .52), "Density": 1.}
        return scene(2, {"Ball": ball}, coupling, level=.5, step=.02, cells=24).replace(
            'name="Tolerance" type="double" value="1e-10"', f'name="Tolerance" type="double" value="{tolerance}"')

    def test_nothing_lifts_a_pile_through_floor_and_lid(self):
        """It has twice the density of the fluid, and fell with half of gravity."""
        pile = {**box((.25, 3.), (.5, .5), 1.), "Mass": 500., "Locked": ("x", "rotation")}
        del pile["Density"]
        for coupling in ("mixed face",):
            with self.subTest(coupling=coupling):
                bodies, _ = self.run_scene(scene(2, {"Pile": pile}, coupling, level=None, step=.01, cells=16, Contact={"Type": "none"}), 1)
                self.assertAlmostEqual(float(bodies[-1]["vy"]), -G * .01, delta=1e-9)


unittest.main()
