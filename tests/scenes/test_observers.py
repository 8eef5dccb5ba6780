"""Observers of solids and of flows in any direction, where the answer is known: paths of points of bodies, gauges that ride on
one, volume through windows that are tilted; after a restart and on two ranks, too."""
import math
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from scene_xml import xml  # noqa: E402
from simulation import attempt, column, simulate, table  # noqa: E402

PERIODIC = {f"{axis} {end}": {"Type": "periodic"} for axis in "xyz" for end in ("lower", "upper")}


def scene(dimension, observers, solids=(), fluid=(), sides=(), **more):
    return xml("Scene", {
        "Dimension": dimension,
        "Domain": {"Cells": (16,) * dimension, "Sides": {name: side for name, side in dict(sides).items() if name[0] in "xyz"[:dimension]}},
        "Fluid": {"Density": 1., **dict(fluid)}, "Solids": dict(solids), "Observers": observers,
        "Time": {"End": .05, "Fixed Step": .01}, "Solver": {"Tolerance": 1e-12}, "Output": {"Frames": False}, **more})


def ball(**more):
    return {"Type": "rigid body", "Geometry": {"Shape": "ball", "Radius": .2}, **more}


class Observers(unittest.TestCase):
    def tables(self, text, *names, ranks=1):
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "scene.xml").write_text(text)
            simulate(Path(folder) / "scene.xml", Path(folder) / "output", ranks=ranks)
            return [table(Path(folder) / f"output/{name}.csv") for name in names]

    def refusal(self, text):
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "scene.xml").write_text(text)
            result = attempt(Path(folder) / "scene.xml", Path(folder) / "output", "--validate")
            self.assertEqual(result.returncode, 2, result.stdout)
            return result.stdout


class Flows(Observers):
    def test_a_uniform_flow_through_a_tilted_line(self):
        """U n L to round-off, to the right of the way; the same through the line from its other end, less its sign."""
        ends, velocity = (.3, .2, .7, .9), (1., 2.)
        wanted = velocity[0] * (ends[3] - ends[1]) - velocity[1] * (ends[2] - ends[0])
        observers = {"there": {"Type": "flow", "Points": ends}, "back": {"Type": "flow", "Points": ends[2:] + ends[:2]}}
        there, back = self.tables(scene(2, observers, fluid={"Velocity": velocity}, sides=PERIODIC), *observers)
        for row, other in zip(there, back):
            self.assertAlmostEqual(float(row["volume_rate"]), wanted, delta=1e-12)
            self.assertAlmostEqual(float(other["volume_rate"]), -wanted, delta=1e-12)
            self.assertAlmostEqual(float(row["open_area"]), math.hypot(.4, .7), delta=1e-12)

    def test_a_uniform_flow_through_a_parallelogram(self):
        """U times the cross product of its edges, here (.2, .3, .1) and (.1, -.2, .3)."""
        velocity, product = (1., 2., 3.), (.11, -.05, -.07)
        observers = {"window": {"Type": "flow", "Points": (.3, .4, .2, .5, .7, .3, .4, .2, .5)}}
        window, = self.tables(scene(3, observers, fluid={"Velocity": velocity}, sides=PERIODIC), *observers)
        for row in window:
            self.assertAlmostEqual(float(row["volume_rate"]), sum(u * a for u, a in zip(velocity, product)), delta=1e-12)
            self.assertAlmostEqual(float(row["open_area"]), math.sqrt(sum(a * a for a in product)), delta=1e-12)

    def test_a_shear_flow(self):
        """The midpoint rule has what is linear exactly: u = (y - 1/2, 0) between walls that move with it, at the start."""
        observers = {"line": {"Type": "flow", "Points": (.3, .2, .7, .9)}}
        sides = {**PERIODIC, "y lower": {"Type": "wall", "Velocity": (-.5, 0.)}, "y upper": {"Type": "wall", "Velocity": (.5, 0.)}}
        text = scene(2, observers, fluid={"Velocity": ("y - 0.5", "0")}, sides=sides)
        rows, = self.tables(text, *observers)
        self.assertAlmostEqual(float(rows[0]["volume_rate"]), ((.9 - .5)**2 - (.2 - .5)**2) / 2, delta=1e-12)

    def test_of_a_liquid_the_wet_part_flows(self):
        """Water .53 m deep, in cells of 1/16 m, that goes along at 1 m/s without gravity; wherever the window lies on the grid."""
        for dimension in (2, 3):
            pool = {"Type": "box", "Lower": (-1.,) * dimension, "Upper": (2., .53) + (2.,) * (dimension - 2)}
            sides = {**PERIODIC, "y lower": {"Type": "slip wall"}, "y upper": {"Type": "open"}}
            fluid = {"Velocity": (1.,) + (0.,) * (dimension - 1)}
            across = lambda x, top: {"Type": "flow", "Lower": (x, 0.) + (.1,) * (dimension - 2), "Upper": (x, top) + (1.1,) * (dimension - 2)}  # noqa: E731
            observers = {"whole": across(.5, 1.), "other": across(.53, .97), "wet": across(.5, .5), "dry": {
                "Type": "flow", "Lower": (.5, .6) + (.1,) * (dimension - 2), "Upper": (.5, 1.) + (1.1,) * (dimension - 2)}}
            for interface in ("level set", "volume of fluid"):
                with self.subTest(dimension=dimension, interface=interface):
                    fluid["Free Surface"] = {"Liquid": {"Pool": pool}, "Interface": {"Type": interface}}
                    tables = self.tables(scene(dimension, observers, fluid=fluid, sides=sides), *observers)
                    for rows, wanted in zip(tables, (.53, .53, .5, 0)):
                        for row in rows:
                            self.assertAlmostEqual(float(row["volume_rate"]), wanted, delta=1e-6)
                            self.assertAlmostEqual(float(row["open_area"]), wanted, delta=1e-6)

    def test_both_ways_to_give_a_window_agree(self):
        """A solid stands in some of them."""
        for dimension, box, points in ((2, ((.5, .1), (.5, 1.)), (.5, .1, .5, 1.)), (2, ((.1, .5), (.9, .5)), (.9, .5, .1, .5)),
                                       (3, ((.1, .5, .2), (.9, .5, .8)), (.1, .5, .2, .1, .5, .8, .9, .5, .2))):
            with self.subTest(points=points):
                flat = {"Lower": box[0], "Upper": box[1]}
                observers = {"box": {"Type": "flow", **flat}, "points": {"Type": "flow", "Points": points}}
                sides = {**PERIODIC, "x lower": {"Type": "inflow", "Velocity": (1.,) + (0.,) * (dimension - 1)}, "x upper": {"Type": "open"}}
                solid = ball(Position=(.5,) * dimension, Motion={"Type": "static"})
                by_box, by_points = self.tables(scene(dimension, observers, {"Ball": solid}, sides=sides), *observers)
                for one, other in zip(by_box, by_points):
                    for name in ("volume_rate", "open_area", "mean_pressure"):
                        self.assertAlmostEqual(float(one[name]), float(other[name]), delta=1e-10)

    def test_what_is_no_window(self):
        for window, words in (({"Points": (.1, .1, .1, .1)}, '"Observers/W", the window of a flow has no extent: its "Points" are one'),
                              ({"Points": (.1, .1, .9, 1.2)}, '"Observers/W", the window of a flow sticks out of the fluid: along y'),
                              ({"Points": (.1, .1, .9, .2), "Lower": (0., 0.)}, "give one of the two"),
                              ({"Lower": (0., 0.)}, "give one of the two"), ({}, "give one of the two")):
            with self.subTest(window):
                self.assertIn(words, self.refusal(scene(2, {"W": {"Type": "flow", **window}})))
        self.assertIn("on a line", self.refusal(scene(3, {"W": {"Type": "flow", "Points": (.1, .1, .1, .2, .2, .2, .3, .3, .3)}})))


class Nodes(Observers):
    def test_a_point_of_a_body_that_turns_runs_along_a_circle(self):
        """By a script, to round-off; with its velocity at right angles."""
        omega, start, center = 3., (.6, .55), (.5, .5)
        solid = ball(Position=center, Motion={"Type": "constant velocity"}, **{"Angular Velocity": omega})
        rows, = self.tables(scene(2, {"mark": {"Type": "nodes", "Solid": "Wheel", "Points": start}}, {"Wheel": solid}), "mark")
        arm = [a - b for a, b in zip(start, center)]
        for row in rows:
            c, s = math.cos(omega * float(row["time"])), math.sin(omega * float(row["time"]))
            now = (c * arm[0] - s * arm[1], s * arm[0] + c * arm[1])
            for axis, place, middle, at_start, speed in zip("xy", now, center, start, (-omega * now[1], omega * now[0])):
                self.assertAlmostEqual(float(row[axis]), middle + place, delta=1e-14)
                self.assertAlmostEqual(float(row[f"displacement_{axis}"]), middle + place - at_start, delta=1e-14)
                self.assertAlmostEqual(float(row[f"v{axis}"]), speed, delta=1e-13)

    def test_a_free_body_in_space(self):
        """It keeps its distance from the centre of mass, and v = v_c + w x r."""
        solid = ball(Position=(.5, .5, .5), Density=2., Velocity=(.3, .2, .1), **{"Angular Velocity": (1., 2., -1.)})
        observers = {"mark": {"Type": "nodes", "Solid": "Ball", "Points": (.6, .5, .4, .5, .5, .5)}}
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "scene.xml").write_text(scene(3, observers, {"Ball": solid}))
            simulate(Path(folder) / "scene.xml", Path(folder) / "output")
            rows, bodies = (table(Path(folder) / f"output/{name}.csv") for name in ("mark", "bodies"))
        marks, centers = rows[2::2], rows[3::2]
        for mark, center, body in zip(marks, centers, bodies):
            arm = [float(mark[axis]) - float(body[axis]) for axis in "xyz"]
            self.assertAlmostEqual(math.hypot(*arm), math.hypot(.1, .1), delta=1e-13)
            w = [float(body[f"w{axis}"]) for axis in "xyz"]
            turning = [w[1] * arm[2] - w[2] * arm[1], w[2] * arm[0] - w[0] * arm[2], w[0] * arm[1] - w[1] * arm[0]]
            for a, axis in enumerate("xyz"):
                self.assertAlmostEqual(float(center[axis]), float(body[axis]), delta=1e-12)
                self.assertAlmostEqual(float(mark[f"v{axis}"]), float(body[f"v{axis}"]) + turning[a], delta=1e-12)

    def test_soft_bodies(self):
        """A pinned hem stays, a block that falls freely falls as a whole."""
        pinned = {"Type": "cloth", "Geometry": {"Shape": "sheet", "Size": (0., .4), "Normal": "x"}, "Young's Modulus": 1e4,
                  "Thickness": .01, "Surface Density": 1., "Position": (.3, .6),
                  "Pinned": {"Hem": {"Lower": (-1., .19), "Upper": (1., 1.)}}}
        falling = {"Type": "deformable body", "Geometry": {"Shape": "box", "Size": (.2, .2)}, "Density": 1000., "Position": (.7, .6),
                   "Material": {"Young's Modulus": 1e5}}
        observers = {"hem": {"Type": "nodes", "Solid": "Flag", "Points": (.3, .8)},
                     "corner": {"Type": "nodes", "Solid": "Block", "Points": (.8, .5)}}
        text = scene(2, observers, {"Flag": pinned, "Block": falling}, {"Density": 1e-6, "Gravity": (0., -10.)})
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "scene.xml").write_text(text)
            simulate(Path(folder) / "scene.xml", Path(folder) / "output")
            hem, corner, bodies = (table(Path(folder) / f"output/{name}.csv") for name in ("hem", "corner", "bodies"))
        block = [row for row in bodies if row["name"] == "Block"]
        self.assertEqual({row["displacement_y"] for row in hem}, {"0"})
        self.assertAlmostEqual(float(block[-1]["vy"]), -.5, delta=1e-4)
        for row, body in zip(corner[1:], block):
            self.assertAlmostEqual(float(row["displacement_y"]), float(body["y"]) - .6, delta=1e-7)
            self.assertAlmostEqual(float(row["vy"]), float(body["vy"]), delta=1e-5)

    def test_what_has_no_such_point(self):
        solids = {"Ball": ball(Position=(.5, .5), Density=1.),
                  "Flag": {"Type": "cloth", "Geometry": {"Shape": "sheet", "Size": (0., .4), "Normal": "x"}, "Young's Modulus": 1e4,
                           "Thickness": .01, "Surface Density": 1., "Position": (.1, .6)},
                  "Rope": {"Type": "spring", "Solids": ("space", "Ball"), "Points": (.5, .9, .5, .7), "Stiffness": 1.}}
        for name, words in (("Bal", '"Observers/N" follows the solid "Bal", but there is none; did you mean "Ball"?'),
                            ("Flag", 'point 0.6, 0.5, which is 0.5 m from the surface of "Flag"'),
                            ("Rope", '"Rope", which has no surface')):
            with self.subTest(name):
                text = scene(2, {"N": {"Type": "nodes", "Solid": name, "Points": (.6, .5)}}, solids)
                self.assertIn(words, self.refusal(text))


class Gauges(Observers):
    def test_a_gauge_rides_on_a_body(self):
        """Its place is that of a point of the body, its pressure that of a gauge there; on a body at rest that of one in space."""
        up = ball(Position=(.5, .5), Motion={"Type": "constant velocity"}, Velocity=(0., .5), **{"Angular Velocity": 1.})
        still = ball(Position=(.2, .2), Motion={"Type": "static"})
        observers = {"riding": {"Type": "points", "Solid": "Up", "Points": (.75, .5)},
                     "node": {"Type": "nodes", "Solid": "Up", "Points": (.75, .5)},
                     "bow": {"Type": "box", "Solid": "Still", "Lower": (.2, .42), "Upper": (.3, .42), "Count": (3, 1)},
                     "space": {"Type": "box", "Lower": (.2, .42), "Upper": (.3, .42), "Count": (3, 1)}}
        sides = {"y upper": {"Type": "open"}}
        text = scene(2, observers, {"Up": up, "Still": still}, {"Gravity": (0., -10.)}, sides)
        riding, node, bow, space = self.tables(text, *observers)
        self.assertEqual([(row["x"], row["y"]) for row in riding], [(row["x"], row["y"]) for row in node])
        self.assertEqual({row["in_fluid"] for row in riding}, {"1"})
        self.assertGreater(float(riding[-1]["y"]), .53)
        self.assertEqual(bow, space)
        end = (float(riding[-1]["x"]), float(riding[-1]["y"]))
        fixed, = self.tables(text.replace('<ParameterList name="Observers">', '<ParameterList name="Observers">' + xml(
            "fixed", {"Type": "points", "Points": end})), "fixed")
        self.assertAlmostEqual(float(fixed[-1]["pressure"]), float(riding[-1]["pressure"]), delta=1e-9)

    def test_restarts_and_ranks(self):
        solids = {"Ball": ball(Position=(.5, .5), Density=2., Velocity=(.3, .2), **{"Angular Velocity": 1.}),
                  "Flag": {"Type": "cloth", "Geometry": {"Shape": "sheet", "Size": (0., .4), "Normal": "x"}, "Young's Modulus": 1e4,
                           "Thickness": .01, "Surface Density": 1., "Position": (.1, .6), "Velocity": (.1, 0.)}}
        observers = {"node": {"Type": "nodes", "Solid": "Ball", "Points": (.6, .5, .3, .3)}, "cloth": {"Type": "nodes", "Solid": "Flag", "Points": (.1, .55)},
                     "gauge": {"Type": "points", "Solid": "Ball", "Points": (.75, .5)}, "bow": {"Type": "points", "Solid": "Flag", "Points": (.15, .55)}}
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            (folder / "scene.xml").write_text(scene(2, observers, solids))
            for output, ranks, options in (("one", 1, ()), ("two", 2, ()), ("again", 1, ("--steps", 2))):
                simulate(folder / "scene.xml", folder / output, *options, ranks=ranks)
            checkpoint = sorted((folder / "again").glob("checkpoint-*.h5"))[-1]
            simulate(folder / "scene.xml", folder / "again", "--restart", checkpoint)
            for table_name in observers:
                text = (folder / f"one/{table_name}.csv").read_text()
                self.assertEqual(text, (folder / f"again/{table_name}.csv").read_text(), table_name)
                one, two = (table(folder / output / f"{table_name}.csv") for output in ("one", "two"))
                for key in one[0]:
                    for a, b in zip(column(one, key), column(two, key)):
                        self.assertAlmostEqual(a, b, delta=1e-7, msg=f"{table_name} {key}")


if __name__ == "__main__":
    unittest.main()
