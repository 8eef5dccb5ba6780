"""The Python package: scenes as dictionaries and texts, what a run shows, observers, callbacks, new starts, names and types."""
import ast
import inspect
import math
import re
import tempfile
import unittest
from pathlib import Path

import lockstep
import numpy as np
from lockstep import _core

ROOT = Path(__file__).resolve().parents[2]
import sys  # noqa: E402

sys.path[:0] = [str(ROOT / "tests" / "support")]
from scene_xml import xml  # noqa: E402
from simulation import column, simulate, table, without_times  # noqa: E402
from tanks import GRAVITY, ball, tank, unseen_box  # noqa: E402


class Folder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.root = Path(folder.name)
        self.addCleanup(folder.cleanup)

    def open(self, scene, **more):
        return lockstep.Run(scene, self.root / "run", **more)

    def refused(self, scene):
        with self.assertRaises(lockstep.InputError) as caught:
            self.open(scene)
        self.assertFalse((self.root / "run").exists())
        return str(caught.exception)


class Scenes(Folder):
    def steps(self, scene, name):
        with lockstep.Run(scene, self.root / name) as run:
            while run.step():
                pass
        return without_times(table(self.root / name / "history.csv"))

    def test_dictionary_text_and_file_are_one_scene(self):
        scene = tank(solids={"Ball": ball()})
        text = xml("Scene", scene)
        (self.root / "scene.xml").write_text(text)
        rows = [self.steps(one, name) for one, name in ((scene, "a"), (text, "b"), (self.root / "scene.xml", "c"))]
        self.assertEqual(len(rows[0]), 5)
        self.assertEqual(rows[0], rows[1])
        self.assertEqual(rows[0], rows[2])
        used = [(self.root / name / "used-parameters.xml").read_text().splitlines()[1:] for name in "abc"]
        self.assertEqual(used[0], used[1])
        self.assertEqual(used[0], used[2])

    def test_the_folder_of_a_dictionary_has_its_scene(self):
        rows = self.steps(tank(solids={"Ball": ball()}), "run")
        simulate(self.root / "run" / "input.xml", self.root / "again")
        self.assertEqual(rows, without_times(table(self.root / "again" / "history.csv")))

    def test_numbers_take_the_declared_type(self):
        """Whole numbers for doubles, numpy's, large ones, lists; in copies of a solid, too."""
        box = {"Type": "deformable body", "Geometry": {"Shape": "box", "Size": [1, np.float32(.25)], "Mesh Spacing": np.array(.125)},
               "Material": {"Type": "linear", "Young's Modulus": 10**10}, "Density": 900, "Position": np.array([1, 1])}
        solids = {"Box": box, "Ball": {**ball(), "Copies": {"Type": "lattice", "Count": (2, 1), "Spacing": (1, 1)}, "Position": (.5, 1.6)}}
        scene = tank(solids=solids, Domain={"Upper": (2, 2), "Cells": np.array((16, 16))}, Time={"Steps": np.int64(1), "End": 1}, Solver={"Tolerance": 1e-8})
        with self.open(scene) as run:
            self.assertEqual(run.grid.cells, (16, 16))
            self.assertEqual(set(run.bodies()), {"Box", "Ball 1", "Ball 2"})
            self.assertTrue(run.step())
            self.assertFalse(run.step())

    def test_formulas(self):
        solids = {"Box": {**unseen_box(), "Force": ("M*4*t", 0), "Mass": "[M]"}}
        for force in (("[M*4*t]", 0), ("[4*M*t]", "[0]")):
            solids["Box"]["Force"] = force
            with self.open(tank(solids=solids, Constants={"M": 2, "N": "2*M"}, Fluid={"Density": 1}, Contact={"Type": "none"},
                                Time={"End": .4, "Fixed Step": .01})) as run:
                while run.step():
                    pass
                self.assertAlmostEqual(run.bodies()["Box"]["velocity"][0], 2 * .4**2, delta=.02)

    def test_mistakes_of_a_dictionary_are_told(self):
        told = self.refused(tank(solids={"Ball": ball(Densty=3.)}))
        self.assertIn('the dictionary of the scene: in "Solids/Ball", "Densty" is not a parameter. Did you mean "Density"', told)
        told = self.refused(tank(Domain={"Cells": (16.0, 16)}, Fluid={"Density": "heavy"}))
        self.assertRegex(told, r'"Cells" .*"16.0", which is not an integer \(write 16\)')
        self.assertRegex(told, r'"Density" is the string "heavy", but must be a number')
        self.assertNotIn("line", told)
        for scene, sentence in ((tank(Title=None), r'"Title" is None; a parameter is a bool'),
                                (tank(Domain={"Upper": (1, math.nan)}), '"Domain/Upper" is nan, but must be finite'),
                                (tank(Domain={3: 4}), 'in "Domain", the name 3 is no text'),
                                (tank(Solver={"x": (("a",),)}), "a parameter is a bool, a number"),
                                ({}, '"Dimension" .* is required')):
            self.assertRegex(self.refused(scene), sentence)

    def test_mistakes_of_a_text_have_lines(self):
        told = self.refused(xml("Scene", tank(solids={"Ball": ball(Densty=3.)})))
        self.assertRegex(told, r'the text of the scene, line \d+: in "Solids/Ball", "Densty"')
        self.assertIn("well-formed", self.refused("  <ParameterList"))

    def test_settings_may_be_nested(self):
        with self.open(tank(), settings={"Time": {"Steps": 2}, "Domain/Cells": (8, 8)}) as run:
            self.assertEqual(run.grid.shape, (8, 8))
            while run.step():
                pass
            self.assertEqual(run.n_steps, 2)
        with self.assertRaisesRegex(lockstep.InputError, '"Time/Stepps" is not|"Stepps" is not'):
            self.open(tank(), settings={"Time": {"Stepps": 2}})
        with self.assertRaisesRegex(lockstep.InputError, 'the setting "Time/Steps" is None'):
            self.open(tank(), settings={"Time": {"Steps": None}})
        with self.assertRaisesRegex(lockstep.InputError, '^the setting "Time/End=long": in "Time", "End" is "long", which is not a number'):
            self.open(tank(), settings={"Time/End": "long"})

    def test_settings_know_the_constants(self):
        settings = {"Domain/Upper": (2, 1), "Domain/Cells": ("[2*N]", "[N]"), "Fluid/Density": "[100*N]"}
        with self.open(tank(Constants={"N": 8}), settings=settings) as run:
            self.assertEqual(run.grid.cells, (16, 8))
        with self.assertRaisesRegex(lockstep.InputError, 'Did you mean "N"'):
            self.open(tank(Constants={"N": 8}), settings={"Fluid/Density": "[100*NN]"})


class Views(Folder):
    def test_grid(self):
        with self.open(tank(3, Domain={"Lower": (0, 1, 2), "Upper": (2, 2, 3), "Cells": (16, 8, 8)})) as run:
            grid = run.grid
            self.assertEqual((grid.cells, grid.shape), ((16, 8, 8), (8, 8, 16)))
            np.testing.assert_allclose(grid.spacing, .125)
            np.testing.assert_allclose(grid.origin, (0, 1, 2))
            self.assertEqual(run.fields()["pressure"].shape, grid.shape)
            x, y, z = grid.centers()
            there, _, _ = run.sample([(x[0], y[-1], z[3])])
            self.assertTrue(there[0])
            np.testing.assert_allclose((x[0], y[-1], z[3]), (.0625, 1.9375, 2.4375))

    def test_points_outside_of_the_domain_are_refused(self):
        with self.open(tank()) as run:
            low, high = run.grid.origin, run.grid.origin + run.grid.spacing * run.grid.cells
            self.assertTrue(run.sample([low, high])[0].all())
            for point in (high + (0, 1e-3), low - (1e-3, 0)):
                with self.assertRaisesRegex(lockstep.InputError, "is outside of the domain, which goes from"):
                    run.sample([(low + high) / 2, point])
        sides = {f"x {end}": {"Type": "periodic"} for end in ("lower", "upper")}
        with self.open(tank(Domain={"Cells": (16, 16), "Sides": sides})) as run:
            self.assertTrue(run.sample([high + (3, -.01)])[0].all())

    def test_time_step(self):
        with self.open(tank(solids={"Ball": ball()})) as run:
            self.assertEqual(run.time_step, 0)
            run.step()
            self.assertAlmostEqual(run.time_step, .01)
            self.assertEqual(run.time_step, run.history["dt"])

    def test_forces_are_those_of_the_table(self):
        for dimension, axes in ((2, "xy"), (3, "xyz")):
            turns = axes if dimension == 3 else "z"
            scene = tank(dimension, {"Ball": ball(dimension, density=3000., Position=(.45, .2005, .5)[:dimension])},
                         Domain={"Cells": (12,) * dimension})
            with self.subTest(dimension=dimension), self.open(scene) as run:
                np.testing.assert_array_equal(run.bodies()["Ball"]["force"], 0)
                while run.step():
                    body = run.bodies()["Ball"]
                row = table(self.root / "run" / "bodies.csv")[-1]
                for name, prefix, letters in (("force", "f", axes), ("torque", "t", turns), ("contact_force", "contact_f", axes),
                                              ("contact_torque", "contact_t", turns)):
                    np.testing.assert_array_equal(body[name], [float(row[prefix + letter]) for letter in letters])
                self.assertGreater(body["force"][1], 0)
                self.assertGreater(body["contact_force"][1], 0)  # it lies on the floor before the end

    def test_orientation(self):
        """A turn about an axis, out of the turned position where it starts."""
        for dimension, rotation, spin in ((2, .3, 2.), (3, (.3, 0., 0.), (2., 0., 0.))):
            box = {**unseen_box(dimension), "Rotation": rotation, "Angular Velocity": spin}
            scene = tank(dimension, {"Box": box}, Fluid={"Density": 1., "Gravity": (0.,) * dimension}, Contact={"Type": "none"},
                         Domain={"Cells": (8,) * dimension})
            with self.subTest(dimension=dimension), self.open(scene) as run:
                start = run.bodies()["Box"]["orientation"]
                cosine, sine = math.cos(.3), math.sin(.3)
                expected = np.eye(dimension)
                expected[-2:, -2:] = ((cosine, -sine), (sine, cosine))
                np.testing.assert_allclose(start, expected, atol=1e-12)
                while run.step():
                    pass
                now = run.bodies()["Box"]["orientation"]
                np.testing.assert_allclose(now @ now.T, np.eye(dimension), atol=1e-12)
                self.assertAlmostEqual(math.atan2(now[-1, -2], now[-2, -2]), .3 + 2 * run.time, delta=1e-9)
                corners = run.surfaces()["Box"][0] - run.bodies()["Box"]["position"]
                along = np.abs(corners @ now).max(axis=0)  # in the axes of the box
                np.testing.assert_allclose(along, (.5, .1, .1)[:dimension], atol=1e-9)

    def test_nodes_and_surfaces(self):
        box = {"Type": "deformable body", "Geometry": {"Shape": "box", "Size": (.5, .25), "Mesh Spacing": .0625},
               "Material": {"Type": "linear", "Young's Modulus": 1e5}, "Density": 900, "Position": (.5, .5)}
        with self.open(tank(solids={"Box": box, "Ball": ball(Position=(.25, .25), Geometry={"Shape": "ball", "Radius": .1})})) as run:
            self.assertIsNone(run.bodies()["Box"]["orientation"])
            nodes = run.nodes("Box")
            vertices, segments = run.surface("Box")
            self.assertEqual((nodes.shape[1], segments.shape[1]), (2, 2))
            self.assertGreater(len(nodes), len(vertices))
            np.testing.assert_allclose(nodes.min(axis=0), (.25, .375), atol=1e-12)
            np.testing.assert_allclose(vertices.max(axis=0), (.75, .625), atol=1e-12)
            lengths = np.linalg.norm(np.diff(vertices[segments], axis=1), axis=2)
            self.assertAlmostEqual(lengths.sum(), 1.5, delta=1e-12)
            np.testing.assert_array_equal(run.nodes("Ball"), run.surface("Ball")[0])


class Functions(Folder):
    def test_callbacks_come_after_each_step(self):
        times = []
        with self.open(tank(solids={"Ball": ball()})) as run:
            @run.on_step
            def note(given):
                self.assertIs(given, run)
                times.append(given.time)

            while run.step():
                self.assertEqual(times[-1], run.time)
        self.assertEqual(len(times), 5)

    def test_a_callback_that_fails_ends_the_run(self):
        with self.assertRaisesRegex(RuntimeError, "not today"), self.open(tank(solids={"Ball": ball()})) as run:
            run.on_step(lambda _: (_ for _ in ()).throw(RuntimeError("not today")))
            run.step()
        self.assertIn("RuntimeError: not today", (self.root / "run" / "summary.json").read_text())

    def test_observers_write_tables(self):
        with self.open(tank(solids={"Ball": ball()})) as run:
            run.observe("place of the ball", lambda run: run.bodies()["Ball"]["position"], [("x", "m"), ("y", "m")])
            run.observe("energy", lambda run: run.bodies()["Ball"]["kinetic_energy"], ["kinetic"])
            while run.step():
                pass
        rows = table(self.root / "run" / "place of the ball.csv")
        bodies = table(self.root / "run" / "bodies.csv")
        self.assertEqual([row["step"] for row in rows], [str(n) for n in range(6)])
        self.assertEqual(rows[0]["y"], "0.45000000000000001")
        self.assertEqual(column(rows, "y")[1:], column(bodies, "y"))
        self.assertEqual(column(rows, "time")[1:], column(bodies, "time"))
        self.assertGreater(column(table(self.root / "run" / "energy.csv"), "kinetic")[-1], 0)
        self.assertRegex((self.root / "run" / "place of the ball.csv").read_text(), r"# .*\bm\b")

    def test_observers_go_on_from_a_checkpoint(self):
        scene, all_rows = tank(solids={"Ball": ball()}, Output={"Frames": False, "Checkpoints": {"Interval": .02, "Count": 9}}), []
        for restart in ("", self.root / "run" / "checkpoint-000002.h5"):
            with self.open(scene, restart=restart) as run:
                run.observe("height", lambda run: run.bodies()["Ball"]["position"][1], ["y"])
                while run.step():
                    pass
            all_rows.append(table(self.root / "run" / "height.csv"))
        self.assertEqual(len(all_rows[0]), 6)
        self.assertEqual(*all_rows)

    def test_wrong_observers_are_refused(self):
        scene = tank(Observers={"energy": {"Type": "energy"}})
        with self.open(scene) as run:
            for arguments, error, sentence in ((("a/b", lambda _: 1, ["x"]), lockstep.InputError, "cannot be the name of a file"),
                                               (("lines", lambda _: 1, ["x"]), lockstep.InputError, "a table that runs have"),
                                               (("energy", lambda _: 1, ["x"]), lockstep.InputError, "observer \"energy\" already"),
                                               (("two", lambda _: (1, 2), ["x"]), lockstep.InputError, "returned 2 numbers; it has 1"),
                                               (("word", lambda _: "up", ["x"]), lockstep.InputError, "neither a number"),
                                               (("x", lambda _: 1, "x"), lockstep.InputError, "a list of names"),
                                               (("again", lambda _: 1, ["time"]), lockstep.InputError, 'not "step" or "time"'),
                                               (("break", lambda _: 1, ["a\nb"]), lockstep.InputError, "of one line"),
                                               (("nan", lambda _: math.nan, ["x"]), lockstep.OutputError, 'nan for its column "x"')):
                with self.subTest(name=arguments[0]), self.assertRaisesRegex(error, sentence):
                    run.observe(*arguments)
            self.assertEqual([file.name for file in (self.root / "run").glob("*.csv")].count("two.csv"), 0)
            self.assertTrue(run.step())  # none of them is left


class Reset(Folder):
    def test_the_same_run_again(self):
        found = []
        with self.open(tank(solids={"Ball": ball()})) as run:
            run.observe("height", lambda run: run.bodies()["Ball"]["position"][1], ["y"])
            run.on_step(lambda run: found[-1].append(run.time))
            for push in (0., 300., 0.):
                found.append([])
                self.assertEqual((run.time, run.n_steps, run.time_step), (0, 0, 0))
                while run.step():
                    run.set_force("Ball", (push, 0.)) if push else None
                found[-1].append(tuple(run.bodies()["Ball"]["position"]))
                if len(found) < 3:
                    run.reset()
        self.assertEqual(found[0], found[2])
        self.assertGreater(found[1][-1][0], found[0][-1][0] + 1e-4)
        self.assertEqual(len(table(self.root / "run" / "height.csv")), 6)
        self.assertEqual(len(table(self.root / "run" / "history.csv")), 5)
        self.assertIn('"done"', (self.root / "run" / "summary.json").read_text())

    def test_a_run_that_failed_starts_again(self):
        with self.open(tank(solids={"Ball": ball()})) as run:
            run.set_force("Ball", (1e300, 0.))
            with self.assertRaises((lockstep.SolveError, lockstep.OutputError)):
                while run.step():
                    pass
            run.reset()
            self.assertTrue(run.step())

    def test_back_to_the_checkpoint(self):
        scene = tank(solids={"Ball": ball()}, Output={"Frames": False, "Checkpoints": {"Interval": .02, "Count": 9}})
        with self.open(scene) as run:
            while run.step():
                pass
            end = run.bodies()["Ball"]["position"]
        with self.open(scene, restart=self.root / "run" / "checkpoint-000002.h5") as run:
            run.step()
            run.reset()
            self.assertEqual(run.n_steps, 2)
            while run.step():
                pass
            np.testing.assert_array_equal(run.bodies()["Ball"]["position"], end)

    def test_a_closed_run_stays_closed(self):
        with self.open(tank()) as run:
            pass
        with self.assertRaisesRegex(lockstep.InputError, "closed"):
            run.reset()


class Names(Folder):
    def test_near_names(self):
        joint = {"Type": "hinge", "Solids": ("Box", "space"), "Point": (0., .5), "Control": "prescribed", "Target": {"Type": "constant"}}
        with self.open(tank(solids={"Box": unseen_box(), "Ball": ball()}, Joints={"Knee": joint}, Contact={"Type": "none"})) as run:
            run.step()
            for call, error, sentence in (
                    (lambda: run.bodies()["Bal"], KeyError, 'no solid "Bal". Did you mean "Ball"\\? There are: "Box", "Ball"'),
                    (lambda: run.bodies()["Ball"]["forse"], KeyError, 'Did you mean "force"'),
                    (lambda: run.history["momentm_error"], KeyError, 'Did you mean "momentum_error"'),
                    (lambda: run.fields()["presure"], KeyError, 'Did you mean "pressure"'),
                    (lambda: run.joints()["Kne"], KeyError, 'Did you mean "Knee"'),
                    (lambda: run.surface("Bell"), KeyError, 'Did you mean "Ball"'),
                    (lambda: run.nodes("Bell"), KeyError, 'no solid "Bell". Did you mean "Ball"\\? There are: "Ball"'),
                    (lambda: run.steps, AttributeError, 'A Run has no attribute "steps". Did you mean "step"'),
                    (lambda: run.grid.spaceing, AttributeError, 'A Grid has no attribute "spaceing". Did you mean "spacing"'),
                    (lambda: run.set_force("Bell", (0, 0)), lockstep.InputError, 'no solid "Bell". Did you mean "Ball"'),
                    (lambda: run.set_target("Kne", 0), lockstep.InputError, 'no joint "Kne". Did you mean "Knee"')):
                with self.assertRaisesRegex(error, sentence):
                    call()

    def test_errors_are_those_of_python(self):
        for error, kind in ((lockstep.InputError, ValueError), (lockstep.SolveError, ArithmeticError), (lockstep.OutputError, OSError)):
            self.assertTrue(issubclass(error, kind))
            self.assertEqual(error.__module__, "lockstep")


def public(names):
    return {name for name in names if not name.startswith("_")}


class Types(unittest.TestCase):
    PACKAGE = Path(lockstep.__file__).parent

    def test_the_stub_has_the_names_of_the_module(self):
        tree = ast.parse((self.PACKAGE / "_core.pyi").read_text())
        tops = {node.name: node for node in tree.body if isinstance(node, (ast.ClassDef, ast.FunctionDef))}
        self.assertEqual(set(tops), public(dir(_core)))
        for name in ("Run", "OpenRequest"):
            members = {getattr(node, "name", None) or node.target.id for node in tops[name].body}
            self.assertEqual(public(members), public(dir(getattr(_core, name))), name)

    def test_types_are_marked(self):
        self.assertTrue((self.PACKAGE / "py.typed").exists())

    def test_everything_is_documented_and_typed(self):
        self.assertEqual(public(vars(lockstep)) - {"names", "run", "scene_text"}, public(lockstep.__all__))
        for name in public(dir(lockstep.Run)):
            with self.subTest(name=name):
                member = inspect.getattr_static(lockstep.Run, name)
                self.assertTrue(inspect.getdoc(member))
                function = member.fget if isinstance(member, property) else member
                signature = inspect.signature(function)
                self.assertIsNot(signature.return_annotation, signature.empty)
                for parameter in list(signature.parameters.values())[1:]:
                    self.assertIsNot(parameter.annotation, parameter.empty, parameter.name)

    def test_quantities_have_units(self):
        for name in ("bodies", "joints", "surface", "nodes", "fields", "sample", "set_force", "set_target", "time", "time_step"):
            self.assertRegex(inspect.getdoc(inspect.getattr_static(lockstep.Run, name)), r"\[(m|s|N|rad|Pa)[\],/]", name)

    def test_the_tutorial_names_every_member(self):
        text = (ROOT / "docs" / "tutorials" / "steer-from-python.md").read_text()
        for name in public(dir(lockstep.Run)):
            self.assertTrue(re.search(rf"`[^`]*\b{name}\b", text), name)


if __name__ == "__main__":
    unittest.main()
