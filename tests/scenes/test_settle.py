"""`Time/Settle`: floating and moored rigid bodies, let go away from their equilibrium, rest from the first step on, as Archimedes has it."""
import math
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from scene_xml import xml  # noqa: E402
from simulation import attempt, column, simulate, table  # noqa: E402

ROOT = Path(__file__).resolve().parents[2]
G, LEVEL, BEAM, DRAFT = 9.81, .7, .4, .1


def scene(dimension, solids, settle=True, **more):
    """A unit tank of still water; vertical is the last axis."""
    return xml("Scene", {
        "Dimension": dimension, "Domain": {"Cells": (24 if dimension == 2 else 16,) * dimension, **more.pop("Domain", {})},
        "Fluid": {"Density": 1000., "Gravity": (0.,) * (dimension - 1) + (-G,),
                  "Free Surface": {"Liquid": {"Pool": {"Type": "level", "Height": LEVEL}}}},
        "Solids": solids, "Solver": {"Tolerance": 1e-11}, "Time": {"End": 100., "Fixed Step": .01, "Settle": settle},
        "Output": {"Frames": False}, **more})


def hull(dimension, **more):
    """A box of half the density of water with ballast, heeled and too high."""
    width = (.3,) * (dimension - 2)
    return {"Type": "rigid body", "Geometry": {"Shape": "box", "Size": (BEAM, *width, 2 * DRAFT)},
            "Position": (.5,) * (dimension - 1) + (LEVEL + .03,), "Rotation": .1 if dimension == 2 else (0., -.1, 0.),
            "Mass": 1000. * BEAM * DRAFT * math.prod(width), "Center of Mass": (0.,) * (dimension - 1) + (-.04,), **more}


class Settle(unittest.TestCase):
    def run_scene(self, text, steps=20, *options, ranks=1):
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "scene.xml"
            file.write_text(text)
            simulate(file, Path(folder) / "output", "--steps", steps, *options, ranks=ranks)
            bodies = {}
            for row in table(Path(folder) / "output/bodies.csv"):
                bodies.setdefault(row["name"], []).append(row)
            return bodies, table(Path(folder) / "output/history.csv")

    def fastest(self, rows):
        return max(max(map(abs, column(rows, name))) for name in ("vx", "vy", "vz", "wx", "wy", "wz") if name in rows[0])

    def test_a_ballasted_hull_rests(self):
        for dimension in (2, 3):
            for coupling in ("flux", "mixed face"):
                with self.subTest(dimension=dimension, coupling=coupling):
                    more = {"Coupling": {"Type": coupling}}
                    bodies, history = self.run_scene(scene(dimension, {"Hull": hull(dimension)}, **more))
                    rows = bodies["Hull"]
                    self.assertLess(self.fastest(rows), 1e-6 * math.sqrt(G * BEAM))
                    self.assertLess(max(column(history, "momentum_error")), 1e-12)
                    # The centre of mass lies .04 m below the middle, which is in the surface.
                    up = "xyz"[dimension - 1]
                    self.assertAlmostEqual(float(rows[-1][up]), LEVEL - .04, delta=1e-3 if coupling == "flux" else .01)
                    # Along the surface only errors of the grid hold it: it had gone half of the tank to where these are zero, or to its side.
                    for along in "xy"[:dimension - 1]:
                        self.assertAlmostEqual(float(rows[-1][along]), .5, delta=1 / 16)

    def test_without_it_the_same_hull_swings(self):
        bodies, _ = self.run_scene(scene(2, {"Hull": hull(2)}, settle=False))
        self.assertGreater(self.fastest(bodies["Hull"]), .05)

    def test_a_moored_buoy_rests(self):
        """The shipped scene: two bodies, a damped spring, two lines on the floor; its waves begin afterwards."""
        bodies, _ = self.run_scene((ROOT / "xml-params/scenes/moored-buoy.xml").read_text().replace(
            "../solvers", str(ROOT / "xml-params/solvers")), 20, "--set", "Time/Settle=true", "--set", "Output/Frames=false",
            "--set", "Domain/Sides/x lower/Wave/Height=1e-9", "--set", "Solver/Tolerance=1e-11")
        for name in ("Buoy", "Lantern"):
            self.assertLess(self.fastest(bodies[name]), 1e-6 * math.sqrt(G * .5), name)

    def test_a_hull_that_would_turn_over_lolls(self):
        """Its equilibrium upright is none that lasts: of wall-sided hulls one at the heel with tan^2 = -2 GM / BM is."""
        bm = BEAM**2 / (12 * DRAFT)
        center, tangent = bm - DRAFT / 2 + .005, math.sqrt(2 * .005 / bm)
        bodies, _ = self.run_scene(scene(2, {"Hull": hull(2, **{"Center of Mass": (0., center), "Rotation": .01})}), 2)
        self.assertLess(self.fastest(bodies["Hull"]), 1e-5)
        # The part below the surface is as large at any heel; the middle of the hull stays in it.
        self.assertAlmostEqual((float(bodies["Hull"][-1]["y"]) - LEVEL) / center, 1 / math.hypot(1, tangent), delta=.01)

    def test_ranks_agree(self):
        bar = self.soft((.08, .3), (.5, .45), 1500., 1e5, Pinned={"Top": {"Lower": (-1., .149), "Upper": (1., .151)}})
        for body, text in (("Hull", scene(2, {"Hull": hull(2)})), ("Left", self.raft("flux")), ("Bar", scene(2, {"Bar": bar}))):
            places = [self.run_scene(text, 1, ranks=ranks)[0][body][-1] for ranks in (1, 2)]
            for name in ("x", "y"):
                with self.subTest(body=body, name=name):
                    self.assertAlmostEqual(float(places[0][name]), float(places[1][name]), delta=1e-6)

    def raft(self, coupling, half=.2, tilt=.15):
        """Two boxes, a roof hinged at its ridge."""
        def box(side):
            return {"Type": "rigid body", "Geometry": {"Shape": "box", "Size": (half, .1)}, "Density": 500., "Rotation": -side * tilt,
                    "Position": (.5 + side * half / 2 * math.cos(tilt), LEVEL - half / 2 * math.sin(tilt) + .04)}
        joints = {"Hinge": {"Type": "hinge", "Solids": ("Left", "Right"), "Point": (.5, LEVEL + .04)}}
        return scene(2, {"Left": box(-1), "Right": box(1)}, Joints=joints, Coupling={"Type": coupling})

    def test_a_raft_of_two_boxes_lies_flat(self):
        """Half as dense as water, so that its middle is in the surface."""
        half = .2
        for coupling in ("flux", "mixed face"):
            with self.subTest(coupling=coupling):
                bodies, _ = self.run_scene(self.raft(coupling, half), 10)
                for name in ("Left", "Right"):
                    self.assertLess(self.fastest(bodies[name]), 1e-6 * math.sqrt(G * half), name)
                    self.assertAlmostEqual(float(bodies[name][-1]["y"]), LEVEL, delta=2e-3)
                self.assertAlmostEqual(float(bodies["Right"][-1]["x"]) - float(bodies["Left"][-1]["x"]), half, delta=1e-3)

    def test_a_chain_hangs_from_its_float(self):
        """Three links of iron below a box; its draft carries what they weigh in water."""
        length, thick, density, joints = .12, .03, 2000., {}
        solids = {"Float": {"Type": "rigid body", "Geometry": {"Shape": "box", "Size": (.3, .1)}, "Density": 300.,
                            "Position": (.5, LEVEL + .03)}}
        top = [.5, LEVEL + .03 - .05]
        for k, tilt in enumerate((.5, .2, -.4)):
            along = (math.sin(tilt), -math.cos(tilt))
            solids[f"L{k}"] = {"Type": "rigid body", "Geometry": {"Shape": "box", "Size": (thick, length)}, "Density": density,
                               "Rotation": tilt, "Position": tuple(at + length / 2 * by for at, by in zip(top, along))}
            joints[f"J{k}"] = {"Type": "hinge", "Solids": (f"L{k - 1}" if k else "Float", f"L{k}"), "Point": tuple(top)}
            top = [at + length * by for at, by in zip(top, along)]
        bodies, _ = self.run_scene(scene(2, solids, Joints=joints, Coupling={"Type": "flux"}), 10)
        for name in solids:
            self.assertLess(self.fastest(bodies[name]), 1e-6 * math.sqrt(G * length), name)
            self.assertAlmostEqual(float(bodies[name][-1]["x"]), float(bodies["Float"][-1]["x"]), delta=1e-3)
        draft = (300 * .3 * .1 + 3 * (density - 1000) * length * thick) / (1000 * .3)
        self.assertAlmostEqual(float(bodies["Float"][-1]["y"]), LEVEL - draft + .05, delta=2e-3)

    def test_links_between_two_nails_are_a_catenary(self):
        """Outer ones of four like links are three times as steep as inner ones (by tangents): each carries what hangs below."""
        length, width = .15, .5
        low, high = 0, math.pi / 2
        for _ in range(60):  # angle of the inner links with which they span the width
            inner = (low + high) / 2
            outer = math.atan(3 * math.tan(inner))
            low, high = (inner, high) if 2 * length * (math.cos(inner) + math.cos(outer)) > width else (low, inner)
        solids, joints, at = {}, {}, [.25, .6]
        flat = .4 * inner  # too flat in the middle, and too steep beside
        steep = math.acos(width / 2 / length - math.cos(flat))
        for k, angle in enumerate((-steep, -flat, flat, steep)):
            along = (math.cos(angle), math.sin(angle))
            solids[f"L{k}"] = {"Type": "rigid body", "Geometry": {"Shape": "box", "Size": (length, .03)}, "Density": 3000., "Rotation": angle,
                               "Position": tuple(x + length / 2 * by for x, by in zip(at, along))}
            joints[f"J{k}"] = {"Type": "hinge", "Solids": (f"L{k - 1}" if k else "space", f"L{k}"), "Point": tuple(at)}
            at = [x + length * by for x, by in zip(at, along)]
        joints["J4"] = {"Type": "hinge", "Solids": ("L3", "space"), "Point": tuple(at)}
        bodies, _ = self.run_scene(scene(2, solids, Joints=joints, Coupling={"Type": "flux"}), 10)
        heights = [-length / 2 * math.sin(outer), -length * math.sin(outer) - length / 2 * math.sin(inner)]
        for k, below in enumerate(heights + heights[::-1]):
            self.assertLess(self.fastest(bodies[f"L{k}"]), 1e-6 * math.sqrt(G * length))
            self.assertAlmostEqual(float(bodies[f"L{k}"][-1]["y"]), .6 + below, delta=2e-3)

    def test_a_bar_hangs_on_a_nail(self):
        """In space, a ball joint: two coordinates of which the third, its spin, meets no force."""
        bar = {"Type": "rigid body", "Geometry": {"Shape": "box", "Size": (.1, .1, .3)}, "Density": 1500., "Rotation": (.4, .3, 0.),
               "Position": (.5, .5, .5)}
        length = .15  # from its middle to its upper end
        x, y = .4, .3
        angle = math.hypot(x, y)
        up = (math.sin(angle) * y / angle, -math.sin(angle) * x / angle, math.cos(angle))
        joints = {"Nail": {"Type": "ball", "Solids": ("space", "Bar"), "Point": tuple(.5 + length * at for at in up)}}
        bodies, _ = self.run_scene(scene(3, {"Bar": bar}, Joints=joints, Coupling={"Type": "flux"}), 5)
        self.assertLess(self.fastest(bodies["Bar"]), 1e-6 * math.sqrt(G * length))
        self.assertAlmostEqual(float(bodies["Bar"][-1]["z"]), .5 + length * up[2] - length, delta=1e-4)

    def soft(self, size, position, density, modulus, **more):
        return {"Type": "deformable body", "Geometry": {"Shape": "box", "Size": size, "Mesh Spacing": .04}, "Position": position,
                "Density": density, "Material": {"Type": "st venant-kirchhoff", "Young's Modulus": modulus, "Poisson's Ratio": 0.}, **more}

    def test_a_soft_bar_hangs(self):
        """The pressure below it pushes it up, its weight pulls it down: linear elasticity, without Poisson's ratio one fibre beside the
        other; the grid knows the pressure to some percent."""
        length, density, modulus, top = .3, 1500., 3e6, .6
        bar = self.soft((.08, length), (.5, top - length / 2), density, modulus, Pinned={"Top": {"Lower": (-1., .149), "Upper": (1., .151)}})
        below = 1000 * G * (LEVEL - top + length)
        wanted = (below * length / 2 - density * G * length**2 / 3) / modulus
        for coupling, integration in (("flux", "fully-implicit"), ("mixed face", "fully-implicit"), ("flux", "second-order"), ("flux", "explicit")):
            with self.subTest(coupling=coupling, integration=integration):
                bar["Time Integration"] = integration
                bodies, history = self.run_scene(scene(2, {"Bar": bar}, Coupling={"Type": coupling}), 10)
                self.assertLess(self.fastest(bodies["Bar"]), 1e-6 * math.sqrt(G * length))
                self.assertLess(max(column(history, "solid_kinetic_energy")), 1e-12 * 36 * G * length)
                self.assertAlmostEqual((float(bodies["Bar"][-1]["y"]) - top + length / 2) / wanted, 1, delta=.1)

    def test_a_soft_block_floats_beside_a_hull(self):
        """Half of its height below the surface; rigid ones settle with it."""
        block = self.soft((.3, .12), (.22, LEVEL + .03), 500., 5e4)
        other = hull(2, Position=(.73, LEVEL + .02), Rotation=.02)
        bodies, history = self.run_scene(scene(2, {"Block": block, "Hull": other}, Coupling={"Type": "flux"}), 10)
        for name, y in (("Block", LEVEL), ("Hull", LEVEL - .04)):
            self.assertLess(self.fastest(bodies[name]), 1e-6 * math.sqrt(G * .12), name)
            self.assertAlmostEqual(float(bodies[name][-1]["y"]), y, delta=2e-3)

    def test_cloth_sags_between_its_pins(self):
        """A parabola of sag s is longer than its chord by 8 s^2 / 3 L, of strain H / E t."""
        width, weight, thickness = .4, 6 * G, .002  # the water within it weighs nothing: it has no volume
        for modulus in (1e6, 1e7):
            cloth = {"Type": "cloth", "Geometry": {"Shape": "sheet", "Size": (width, 0.), "Normal": "y", "Mesh Spacing": .02},
                     "Position": (.5, .5), "Young's Modulus": modulus, "Thickness": thickness, "Surface Density": 6.,
                     "Pinned": {end: {"Lower": (x - .001, -.01), "Upper": (x + .001, .01)} for end, x in (("A", -.2), ("B", .2))}}
            bodies, _ = self.run_scene(scene(2, {"Cloth": cloth}, Coupling={"Type": "flux"}), 10)
            self.assertLess(self.fastest(bodies["Cloth"]), 1e-6 * math.sqrt(G * width))
            sag = (3 / 64 * weight * width**4 / (modulus * thickness)) ** (1 / 3)
            self.assertAlmostEqual((.5 - float(bodies["Cloth"][-1]["y"])) / (2 / 3 * sag), 1, delta=.05)

    def test_messages(self):
        dry = xml("Scene", {"Dimension": 2, "Domain": {"Cells": (8, 8)}, "Fluid": {"Density": 1000.},
                            "Solids": {"Hull": hull(2)}, "Time": {"Settle": True}})
        for text, words in ((dry, "there is no gravity"),):
            with self.subTest(words), tempfile.TemporaryDirectory() as folder:
                file = Path(folder) / "scene.xml"
                file.write_text(text)
                result = attempt(file, Path(folder) / "output")
                self.assertEqual(result.returncode, 2, result.stdout)
                self.assertIn(words, result.stdout)


if __name__ == "__main__":
    unittest.main()
