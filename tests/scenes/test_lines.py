"""Springs and mooring lines against closed forms, momentum and energy of what they connect."""
import math
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from scene_xml import xml  # noqa: E402
from simulation import attempt, column, simulate, table  # noqa: E402


def unseen_box(position, mass=1., **more):
    """A box that no fluid sees: it moves as in vacuum."""
    return {"Type": "rigid body", "Geometry": {"Shape": "box", "Size": (.4, .2, .3)[:len(position)]}, "Mass": mass,
            "Seen by Fluid": False, "Position": position, **more}


def spring(solids, points, stiffness, **more):
    return {"Type": "spring", "Solids": solids, "Points": points, "Stiffness": stiffness, **more}


def vacuum(solids, step, end, gravity=0.):
    dimension = len(next(iter(solids.values()))["Position"])
    return {"Dimension": dimension, "Domain": {"Cells": (4,) * dimension},
            "Fluid": {"Density": 1., "Gravity": (0.,) * (dimension - 1) + (-gravity,)}, "Contact": {"Type": "none"},
            "Solids": solids, "Solver": {"Tolerance": 1e-11}, "Time": {"End": end, "Fixed Step": step}, "Output": {"Frames": False}}


def run(scene, *options, ranks=1):
    """history.csv, bodies.csv by name of the body, lines.csv."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "scene.xml"
        file.write_text(xml("Scene", scene))
        simulate(file, Path(folder) / "output", *options, ranks=ranks)
        bodies = {}
        for row in table(Path(folder) / "output/bodies.csv"):
            bodies.setdefault(row["name"], []).append(row)
        return table(Path(folder) / "output/history.csv"), bodies, table(Path(folder) / "output/lines.csv")


class Lines(unittest.TestCase):
    def test_a_mass_on_a_spring(self):
        """x = .6 + .1 cos 2 pi t: of second order, and energy is kept to it."""
        for dimension in (2, 3):
            errors = []
            for step in (.02, .01):
                body = (.7, .5, .5)[:dimension]
                ends = (.2, .5, .5)[:dimension] + body
                solids = {"Mass": unseen_box(body, 2.), "Spring": spring(("space", "Mass"), ends, 2 * (2 * math.pi)**2, Length=.4)}
                history, bodies, _ = run(vacuum(solids, step, 2.))
                errors.append(max(abs(float(row["x"]) - .6 - .1 * math.cos(2 * math.pi * float(row["time"]))) for row in bodies["Mass"]))
                energy = [float(row["solid_kinetic_energy"]) + float(row["elastic_energy"]) for row in history]
                self.assertLess(max(energy) - min(energy), 1e-2 * (step / .02)**2 * energy[0])
                self.assertLess(max(column(history, "momentum_error")), 1e-13)
            with self.subTest(dimension=dimension):
                self.assertLess(errors[1], 1e-3)
                self.assertAlmostEqual(math.log2(errors[0] / errors[1]), 2, delta=.15)

    def test_two_bodies_on_a_spring_keep_their_momentum(self):
        """It ends beside their centres, so that they turn; on two ranks as on one."""
        ends = (.45, .55, .5, 1.4, .48, .62)
        solids = {"Light": unseen_box((.3, .5, .5), 1., Velocity=(.3, 0., -.2), **{"Angular Velocity": (0., 0., 1.)}),
                  "Heavy": unseen_box((1.5, .5, .5), 3., Velocity=(.3, 0., -.2)),
                  "Spring": spring(("Light", "Heavy"), ends, 40., Damping=.5, Length=.7)}
        results = [run(vacuum(solids, .01, 1.), ranks=ranks) for ranks in (1, 2)]
        history, bodies, _ = results[0]
        for axis, velocity in zip("xyz", (.3, 0., -.2)):
            total = [float(a["v" + axis]) + 3 * float(b["v" + axis]) - 4 * velocity for a, b in zip(bodies["Light"], bodies["Heavy"])]
            self.assertLess(max(map(abs, total)), 1e-13)
        self.assertGreater(max(map(abs, column(bodies["Light"], "vx"))), .5)
        self.assertLess(max(column(history, "momentum_error")), 1e-13)
        self.assertLess(max(column(history, "angular_momentum_error")), 1e-13)
        for name in ("x", "y", "z", "vx", "wz"):
            apart = [abs(a - b) for a, b in zip(column(bodies["Light"], name), column(results[1][1]["Light"], name))]
            self.assertLess(max(apart), 1e-10, name)

    def test_a_stiff_spring_bounds_no_step(self):
        """Natural frequency times step: 700."""
        solids = {"Mass": unseen_box((.7, .5), 2., Velocity=(1., 1.)), "Spring": spring(("space", "Mass"), (.2, .5, .7, .5), 4e8)}
        _, bodies, _ = run({**vacuum(solids, .05, 5.), "Solver": {"Tolerance": 1e-8}})
        self.assertLess(max(map(abs, column(bodies["Mass"], "vx") + column(bodies["Mass"], "vy"))), 3.)
        self.assertLess(max(abs(math.hypot(float(row["x"]) - .2, float(row["y"]) - .5) - .5) for row in bodies["Mass"]), .02)

    def test_a_slack_rope_lets_a_body_fall(self):
        rope = {**spring(("space", "Mass"), (.5, .9, .5, .8), 1e4, Length=.5, Damping=100.), "Type": "rope"}
        _, bodies, _ = run(vacuum({"Mass": unseen_box((.5, .8), 1.), "Rope": rope}, .002, 3., gravity=10.))
        fall = [row for row in bodies["Mass"] if float(row["time"]) <= .2]
        self.assertAlmostEqual(float(fall[-1]["y"]), .8 - 5 * float(fall[-1]["time"])**2, delta=1e-10)
        self.assertAlmostEqual(float(bodies["Mass"][-1]["y"]), .4 - 10 / 1e4, delta=1e-4)

    def test_a_mooring_line_at_rest(self):
        """The part s of a line that hangs free of the ground pulls with H = w a, V = w s, and reaches a asinh(s / a) far."""
        a, w, s, rest, mass, gravity = 5., 20., 12., 3., 2., 10.
        for dimension in (2, 3):
            reach, height = rest + a * math.asinh(s / a), math.hypot(a, s) - a
            level = (reach,) if dimension == 2 else (.6 * reach, .8 * reach)
            pull = tuple(w * a * x / reach for x in level)
            solids = {"Buoy": unseen_box((*level, height), mass, Force=(*pull, w * s + mass * gravity)),
                      "Line": {"Type": "mooring line", "Solids": ("space", "Buoy"), "Points": (0.,) * dimension + (*level, height),
                               "Length": s + rest, "Weight": w, "Stiffness": 1e9, "On Floor": True}}
            history, bodies, lines = run(vacuum(solids, .02, 1., gravity))
            fastest = max(max(map(abs, column(bodies["Buoy"], "v" + axis))) for axis in "xyz"[:dimension])
            with self.subTest(dimension=dimension):
                self.assertLess(fastest, 1e-4)
                self.assertAlmostEqual(float(lines[-1]["second_tension"]), 260., delta=1e-3)  # at the fairlead, H = 100 N, V = 240 N
                self.assertAlmostEqual(float(lines[-1]["first_tension"]), 100., delta=1e-3)
                self.assertLess(max(column(history, "momentum_error")), 1e-11)

    def test_messages(self):
        body, fixed = unseen_box((.5, .5)), {**unseen_box((.5, .5)), "Motion": {"Type": "static"}}
        line = {"Type": "mooring line", "Solids": ("space", "A"), "Points": (0., 0., .5, .5), "Length": 1., "Weight": 1., "Stiffness": 1e3}
        cases = (({"A": body, "S": spring(("A", "A"), (0., 0., 1., 1.), 1.)}, 1., "connects \"A\" with itself"),
                 ({"A": body, "S": spring(("A", "B"), (0., 0., 1., 1.), 1.)}, 1., "attached to \"B\""),
                 ({"A": fixed, "S": spring(("space", "A"), (0., 0., 1., 1.), 1.)}, 1., "no solid that is rigid and dynamic"),
                 ({"A": fixed, "S": spring(("space", "A"), (0., 0., 1., 1.), 1.)}, 1., 'The line "S" is attached to "A"'),
                 ({"Hull": body, "S": spring(("space", "Hul"), (0., 0., 1., 1.), 1.)}, 1., 'Did you mean "Hull"? Name one, or "space"'),
                 ({"A": body, "S": spring(("space", "A"), (0., 0., 1., 1.), 0.)}, 1., "neither \"Stiffness\" nor \"Damping\""),
                 ({"A": body, "L": line}, 0., "\"Fluid/Gravity\" is zero"),
                 ({"A": body, "L": {**line, "On Floor": True, "Points": (0., 1., .5, .5)}}, 1., "below its second"))
        for solids, gravity, message in cases:
            with self.subTest(message), tempfile.TemporaryDirectory() as folder:
                file = Path(folder) / "scene.xml"
                file.write_text(xml("Scene", vacuum(solids, .1, 1., gravity)))
                result = attempt(file, Path(folder) / "output")
                self.assertEqual(result.returncode, 2, result.stdout)
                self.assertIn(message, result.stdout)


if __name__ == "__main__":
    unittest.main()
