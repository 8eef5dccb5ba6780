"""The Python module: what it runs, reads and pushes, against the program and against Newton."""
import json
import math
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import lockstep
import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests" / "support"), str(ROOT / "drivers" / "python")]
import turning_fish  # noqa: E402
from scene_xml import xml  # noqa: E402
from simulation import MPIEXEC, simulate, table, without_times  # noqa: E402
from tanks import DENSITY, GRAVITY, ball, tank, unseen_box  # noqa: E402

HALF_TURN = """
import json, os, sys, lockstep
with lockstep.Run(sys.argv[1], sys.argv[2]) as run:
    while run.step():
        run.set_force("Ball", (300., 0.))
    pressure = run.fields()["pressure"]
    found = [*run.bodies()["Ball"]["velocity"], *pressure[::5, ::5].ravel()]
with open(f"{sys.argv[2]}/of-process-{os.getpid()}.json", "w") as file:
    json.dump([float(number) for number in found], file)
"""
FAILS_ON_RANK_0 = """
import os, sys, lockstep
with lockstep.Run(sys.argv[1], sys.argv[2]) as run:
    run.step()
    if os.environ["OMPI_COMM_WORLD_RANK"] == "0":
        try:
            with run:
                raise RuntimeError("not today")
        except RuntimeError as error:
            print(error, file=sys.stderr, flush=True)
            os._exit(1)
    run.step()
"""


class Module(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.root = Path(self.folder.name)
        self.addCleanup(self.folder.cleanup)

    def scene(self, content):
        file = self.root / "scene.xml"
        file.write_text(xml("Scene", content))
        return str(file)

    def open(self, content, **more):
        return lockstep.Run(self.scene(content), str(self.root / "run"), **more)

    def test_runs_as_simulate_does(self):
        scene = ROOT / "xml-params" / "scenes" / "constraints-2d.xml"
        with lockstep.Run(str(scene), str(self.root / "run"), {"Domain/Cells": (24, 24), "Time/Steps": 3}) as run:
            while run.step():
                pass
            self.assertEqual(run.n_steps, 3)
            row = run.history
        simulate(scene, self.root / "same", "--set", "Domain/Cells={24, 24}", "--steps", 3)
        histories, bodies = ([table(self.root / name / file) for name in ("run", "same")]
                             for file in ("history.csv", "bodies.csv"))
        self.assertEqual(bodies[0], bodies[1])
        self.assertEqual(*map(without_times, histories))
        for name, text in histories[0][-1].items():
            self.assertEqual(float(text), row[name], name)
        self.assertIn('"done"', (self.root / "run" / "summary.json").read_text())

    def test_one_run_at_a_time_in_a_folder(self):
        """Two runs in one program cannot share a folder; a run that was closed, or has failed, leaves it to another."""
        with self.open(tank()) as run:
            run.step()
            with self.assertRaisesRegex(lockstep.InputError, "Another run writes to"):
                self.open(tank())
        with self.assertRaisesRegex(RuntimeError, "not today"), self.open(tank()):
            raise RuntimeError("not today")
        with self.open(tank()) as run:
            self.assertTrue(run.step())

    def test_force_and_torque_move_a_body_in_vacuum(self):
        inertia = 2 * 1.04 / 12
        for dimension, torque in ((2, .5), (3, (0., 0., .5))):
            force = np.array((3., -1., 2.)[:dimension])
            scene = tank(dimension, {"Box": unseen_box(dimension)}, Fluid={"Density": 1.}, Contact={"Type": "none"})
            with self.subTest(dimension=dimension), self.open(scene) as run:
                run.set_force("Box", force, torque)
                for _ in range(3):
                    run.step()
                run.set_force("Box", 0 * force)
                while run.step():
                    pass
                box = run.bodies()["Box"]
                np.testing.assert_allclose(box["velocity"], force / 2 * .03, rtol=1e-12)
                self.assertAlmostEqual(box["angular_velocity"][-1], .5 / inertia * .03, delta=1e-12)

    def test_the_ledger_knows_the_force(self):
        for coupling in ("mixed face", "flux"):
            with self.open(tank(solids={"Ball": ball()}, Coupling={"Type": coupling})) as run:
                run.set_force("Ball", (500., 0.), 20.)
                while run.step():
                    self.assertLess(run.history["momentum_error"], 1e-10)
                    self.assertLess(run.history["angular_momentum_error"], 1e-10)
                self.assertGreater(run.bodies()["Ball"]["velocity"][0], .01)

    def test_a_joint_goes_where_it_is_told(self):
        joint = {"Type": "hinge", "Solids": ("Box", "space"), "Point": (0., .5), "Control": "prescribed",
                 "Target": {"Type": "constant"}}
        scene = tank(solids={"Box": unseen_box()}, Joints={"Hinge": joint}, Contact={"Type": "none"})
        with self.open(scene) as run:
            for target in ((math.nan, 0.), (0., math.inf)):
                with self.assertRaisesRegex(lockstep.InputError, '(target|rate) of "Hinge" holds (nan|inf)'):
                    run.set_target("Hinge", *target)
            run.set_target("Hinge", .1, 2.)
            while run.step():
                state, = run.joints()["Hinge"]
                self.assertAlmostEqual(state["q"], .1 + 2. * run.time, delta=1e-12)

    def test_a_joint_of_several_coordinates_is_one(self):
        joint = {"Type": "ball", "Solids": ("space", "Box"), "Point": (0., .5, .5), "Control": "prescribed",
                 "Target": {"Type": "constant"}}
        scene = tank(3, {"Box": unseen_box(3)}, Joints={"Hip": joint}, Contact={"Type": "none"}, Domain={"Cells": (8,) * 3})
        with self.open(scene) as run:
            run.set_target("Hip", np.array((0, 0, 0), dtype=np.float32), (0., 1., 0.))
            while run.step():
                pass
            states = run.joints()["Hip"]
            np.testing.assert_allclose([state["q"] for state in states], (0, run.time, 0), atol=1e-9)
            self.assertFalse(states[0]["at_limit"])

    def test_coordinates_have_targets_of_their_own(self):
        """By the names of joints.csv: the turn of a sleeve is driven, its slide free."""
        joint = {"Type": "cylinder", "Solids": ("space", "Box"), "Point": (0., .5, .5), "Axis": (0., 0., 1.),
                 "Coordinate 2": {"Control": "prescribed", "Target": {"Type": "constant"}}}
        scene = tank(3, {"Box": {**unseen_box(3), "Velocity": (0., 0., .2)}}, Joints={"Sleeve": joint}, Contact={"Type": "none"},
                     Domain={"Cells": (8,) * 3}, Fluid={"Density": 1000., "Gravity": (0., 0., 0.)})
        with self.open(scene) as run:
            run.set_target("Sleeve 2", 0., .7)
            with self.assertRaisesRegex(lockstep.InputError, "\"Sleeve 1\" is free"):
                run.set_target("Sleeve 1", .1)
            while run.step():
                pass
            slide, turn = run.joints()["Sleeve"]
            self.assertAlmostEqual(turn["q"], .7 * run.time, delta=1e-12)
            self.assertAlmostEqual(slide["q"], .2 * run.time, delta=1e-12)
            run.set_target("Sleeve", (9., turn["q"]))  # the target of the free one has no meaning

    def test_a_run_that_failed_goes_no_further(self):
        with self.assertRaises(lockstep.InputError):
            with self.open(tank(solids={"Ball": ball(Force=(1e300, 0.))})) as run:
                with self.assertRaises((lockstep.SolveError, lockstep.OutputError)):
                    while run.step():
                        pass
                run.step()
        self.assertIn('"failed"', (self.root / "run" / "summary.json").read_text())

    def test_a_script_that_fails_leaves_a_checkpoint(self):
        scene = tank(solids={"Ball": ball()})
        with self.assertRaisesRegex(ZeroDivisionError, "by zero"):
            with self.open(scene) as run:
                run.step()
                run.step()
                run.step() / 0
        summary = json.loads((self.root / "run" / "summary.json").read_text())
        self.assertEqual(summary["status"], "stopped by an exception")
        self.assertEqual(summary["message"], "ZeroDivisionError: division by zero")
        with self.open(scene, restart=self.root / "run" / "checkpoint-000003.h5") as run:
            self.assertEqual(run.n_steps, 3)
            while run.step():
                pass
        self.assertIn('"done"', (self.root / "run" / "summary.json").read_text())

    def test_a_script_that_fails_on_one_of_several_ranks_is_not_waited_for(self):
        scene = self.scene(tank(solids={"Ball": ball()}))
        script = self.root / "script.py"
        script.write_text(FAILS_ON_RANK_0)
        start = [MPIEXEC, "--oversubscribe", "-np", "2", sys.executable, str(script), scene, str(self.root / "run")]
        done = subprocess.run(start, capture_output=True, text=True, timeout=120, env=dict(os.environ))
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("not today", done.stderr)
        summary = json.loads((self.root / "run" / "summary.json").read_text())
        self.assertEqual(summary["status"], "stopped by an exception")

    def test_paths_and_numbers_of_every_kind(self):
        """Values of numpy and pathlib are taken: paths that are no texts, and numbers that are arrays without an axis."""
        scene = self.scene(tank(solids={"Box": unseen_box()}, Contact={"Type": "none"}, Fluid={"Density": 1.}))
        settings = {"Time/End": np.array(.02), "Time/Steps": np.int64(1), "Output/Frames": np.bool_(False),
                    "Domain/Cells": np.array((8, 8))}
        with lockstep.Run(Path(scene), self.root / "run", settings) as run:
            run.set_force("Box", (0., 0.), np.array(.5))
            self.assertTrue(run.step())
            self.assertFalse(run.step())
            self.assertGreater(run.bodies()["Box"]["angular_velocity"][0], 0)
        with self.assertRaisesRegex(TypeError, "PathLike"):
            lockstep.Run(3)

    def test_a_scene_in_yaml(self):
        (self.root / "scene.yaml").write_text("Dimension: 2\nDomain: {Cells: [8, 8]}\nTime: {Steps: 1}\nOutput: {Frames: false}\n")
        with lockstep.Run(self.root / "scene.yaml", self.root / "run", {"Domain/Cells": (12, 12)}) as run:
            self.assertTrue(run.step())
            self.assertEqual(run.fields()["pressure"].shape, (12, 12))

    def test_targets_are_those_of_the_present_time(self):
        """Before the first step too, and after a restart; torques begin with a step."""
        joint = {"Type": "hinge", "Solids": ("Box", "space"), "Point": (0., .5), "Control": "proportional derivative",
                 "Natural Frequency": 5., "Target": {"Type": "sinusoid", "Amplitude": .3, "Frequency": 2., "Phase": .4}}
        scene = tank(solids={"Box": unseen_box()}, Joints={"Hinge": joint}, Contact={"Type": "none"})
        for restart, begin in (("", 0.), (str(self.root / "run" / "checkpoint-000003.h5"), .03)):
            with self.open(scene, restart=restart) as run:
                self.assertAlmostEqual(run.time, begin)
                while True:
                    state, = run.joints()["Hinge"]
                    self.assertAlmostEqual(state["target"], .3 * math.sin(4 * math.pi * run.time + .4), delta=1e-12)
                    self.assertEqual(state["torque"] == 0, run.time == begin)
                    if (not restart and run.n_steps == 3) or not run.step():
                        break

    def test_reads_water_at_rest(self):
        for dimension in (2, 3):
            with self.subTest(dimension=dimension), self.open(tank(dimension)) as run:
                run.step()
                fields = run.fields()
                heights = (np.arange(16) + .5) / 16
                pressure = np.moveaxis(fields["pressure"], -2, -1)  # y last
                self.assertEqual(fields["velocity"].shape, (16,) * dimension + (dimension,))
                differences = DENSITY * GRAVITY * (heights[0] - heights)
                np.testing.assert_allclose(pressure - pressure[..., :1],
                                           np.broadcast_to(differences, pressure.shape), atol=1e-6)
                points = np.full((16, dimension), 7.5 / 16)
                points[:, 1] = heights
                there, sampled, velocity = run.sample(points)
                self.assertTrue(there.all())
                np.testing.assert_allclose(sampled - sampled[0], differences, atol=1e-6)
                np.testing.assert_allclose(velocity, 0, atol=1e-10)

    def test_surfaces(self):
        with self.open(tank(3, {"Ball": ball(3)})) as run:
            vertices, triangles = run.surfaces()["Ball"]
            radii = np.linalg.norm(vertices - run.bodies()["Ball"]["position"], axis=1)
            np.testing.assert_allclose(radii, .2, atol=.01)
            self.assertEqual(triangles.shape[1], 3)
            self.assertEqual(len(vertices) - len(triangles) // 2, 2)  # Euler

    def test_goes_on_from_a_checkpoint(self):
        scene = tank(solids={"Ball": ball()}, Output={"Checkpoints": {"Interval": .02, "Count": 9}})
        found = []
        for restart in ("", str(self.root / "run" / "checkpoint-000002.h5")):
            with self.open(scene, restart=restart) as run:
                while run.step():
                    pass
                found.append(run.bodies()["Ball"]["position"])
        np.testing.assert_array_equal(*found)

    def test_two_ranks(self):
        scene = self.scene(tank(solids={"Ball": ball()}))
        script = self.root / "script.py"
        script.write_text(HALF_TURN)
        found = []
        for ranks in (1, 2):
            command = [sys.executable, str(script), scene, str(self.root / f"run-{ranks}")]
            start = [] if ranks == 1 else [MPIEXEC, "--oversubscribe", "-np", str(ranks)]
            # Not with what MPI has put into the environment of this process.
            done = subprocess.run(start + command, capture_output=True, text=True, timeout=120, env=dict(os.environ))
            self.assertEqual(done.returncode, 0, done.stderr)
            told = [json.loads(file.read_text()) for file in (self.root / f"run-{ranks}").glob("of-process-*.json")]
            self.assertEqual(len(told), ranks)
            found += told
        self.assertGreater(abs(found[0][0]), .01)
        for other in found[1:]:
            np.testing.assert_allclose(other, found[0], rtol=1e-7, atol=1e-5)

    def test_errors_have_a_sentence(self):
        given = ball(Motion={"Type": "sinusoid", "Amplitude": (.01, 0.), "Frequency": 1.})
        domain = {"Cells": (16, 16), "Sides": {"y upper": {"Type": "open"}}}
        with self.open(tank(solids={"Ball": ball(Position=(.75, .3)), "Given": {**given, "Position": (.3, .7)}},
                            Domain=domain)) as run:
            for call, sentence in ((lambda: run.set_force("Boll", (0., 0.)), 'no solid "Boll"'),
                                   (lambda: run.set_force("Ball", (0., 0., 0.)), "3 components; it takes 2"),
                                   (lambda: run.set_force("Given", (0., 0.)), "prescribed"),
                                   (lambda: run.set_target("Knee", np.float32(0)), "no joints"),
                                   (lambda: run.set_force("Ball", "up"), "neither a number"),
                                   (lambda: run.set_force("Ball", (0., math.nan)), 'force of "Ball" holds nan'),
                                   (lambda: run.set_force("Ball", (0., 0.), math.inf), 'torque of "Ball" holds inf'),
                                   (lambda: run.sample(np.zeros((1, 3))), "3 coordinates")):
                with self.assertRaisesRegex(lockstep.InputError, sentence):
                    call()
        with self.assertRaisesRegex(ValueError, "closed"):
            run.step()
        with self.assertRaisesRegex(lockstep.InputError, "nothing.xml"):
            lockstep.Run("nothing.xml")

    def test_a_controller_makes_the_fish_turn(self):
        scene = str(ROOT / "xml-params" / "scenes" / "fish-2d.xml")
        left, right = (np.mean(turning_fish.swim(scene, str(self.root / f"fish {bend}"), bend, 6.)[-50:])
                       for bend in (.3, -.3))
        self.assertGreater(math.degrees(left - right), 1.5)  # 2.6 degrees by then; none by waves alike


if __name__ == "__main__":
    os.chdir(tempfile.gettempdir())
    unittest.main()
