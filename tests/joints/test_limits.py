"""Limits of joints, in vacuum: where bodies come to rest, what they lose there, and that they gain nothing; the ledger of
what joints and limits hold in water, on 1, 2 and 4 ranks."""
import math
import tempfile
import unittest

import numpy as np
from jointed_scene import joint, joints_of, run, tank, unseen_box, vacuum

GRAVITY = 9.8
INERTIA = (1 + .2 ** 2) / 12 + .5 ** 2  # inertia of an arm about its end


def limited(solids, joints, step, end, gravity=0., **more):
    """Bodies that no fluid sees, in gravity, with contact, which keeps limits."""
    scene = vacuum(solids, joints, step, end, **more)
    dimension = scene["Dimension"]
    scene["Contact"] = {"Type": "gauss seidel"}
    scene["Fluid"]["Gravity"] = (0., -gravity) + (0.,) * (dimension - 2)
    return scene


def arm(step, end, gravity=GRAVITY, spin=0., **more):
    return limited({"A": unseen_box((0., 0.), spin)}, {"H": joint("hinge", ("space", "A"), (-.5, 0.), **more)}, step, end,
                   gravity)


def links(n, spins=None):
    """A row of boxes, the first one hinged to space."""
    solids = {f"L{k}": unseen_box((k + .5, 0.), 0. if spins is None else spins[k]) for k in range(n)}
    names = ["space", *solids]
    hinges = {f"H{k}": joint("hinge", (names[k], names[k + 1]), (float(k), 0.)) for k in range(n)}
    return solids, hinges


def energy(history, bodies, gravity=GRAVITY):
    height = np.array([[row["y"] for row in rows] for rows in bodies.values()]).sum(axis=0)
    return np.array([row["solid_kinetic_energy"] for row in history]) + gravity * height


class Limits(unittest.TestCase):
    def test_a_pendulum_falls_on_its_limit(self):
        """Freely until it is there, by the sine's law of energy, and no farther; it stays."""
        for step in (.05, .02):
            free = joints_of(arm(step, 1.))["H"]
            rows = joints_of(arm(step, 1., **{"Limits": {"Lower": -.8}}))["H"]
            fallen = next(k for k, row in enumerate(rows) if row["at_limit"] == 1)
            self.assertGreater(fallen * step, .3)
            for row, other in zip(rows[:fallen - 1], free):
                self.assertEqual(row["q"], other["q"])
                speed = math.sqrt(2 * GRAVITY * .5 * math.sin(-row["q"]) / INERTIA)
                self.assertAlmostEqual(-row["rate"], speed, delta=2 * step ** 2 * speed)
            self.assertGreater(min(row["q"] for row in rows), -.8 - .25 * step ** 2)  # error that closing leaves
            for row in rows[fallen + 1:]:
                self.assertAlmostEqual(row["q"], -.8, delta=1e-9)
                self.assertAlmostEqual(row["rate"], 0, delta=1e-9)

    def test_limits_are_known_below_and_above(self):
        for spin in (3., -3.):
            rows = joints_of(arm(.02, 1., 0., spin, **{"Limits": {"Lower": -.3, "Upper": .5}}))["H"]
            self.assertAlmostEqual(rows[-1]["q"], .5 if spin > 0 else -.3, delta=1e-9)

    def test_a_hanging_chain_comes_to_rest_at_its_limits(self):
        """Each hinge bends as far as it may, though the last weighs on all: sweeps would not find that."""
        n = 10
        solids, hinges = links(n)
        for hinge in hinges.values():
            hinge.update({"Limits": {"Lower": -.06, "Upper": .06}})
        scene = limited(solids, hinges, .02, 2., GRAVITY)
        history, bodies = run(scene)
        turn = .02 * max(abs(row["wz"]) for rows in bodies.values() for row in rows)  # in a step
        rows = joints_of(scene)
        for name in hinges:
            self.assertAlmostEqual(rows[name][-1]["q"], -.06, delta=1e-8)
            self.assertGreater(min(row["q"] for row in rows[name]), -.06 - turn ** 2 / 2)
        change = np.diff(energy(history, bodies))
        self.assertLess(change.max(), 1e-3 * np.ptp(energy(history, bodies)))

    def test_a_long_chain_answers_as_one(self):
        """Thirty boxes in a row, free: more unknowns than a block of two or three bodies. Of spins at random, hinges at
        their limits let only those that bend them back: the motion nearest to the free one, by its energy, from a dense
        solve with multipliers and a search for the limits that act."""
        n = 30
        spins = np.random.default_rng(5).normal(size=n)
        solids, hinges = links(n, [float(spin) for spin in spins])
        hinges.pop("H0")
        bounded = [f"H{k}" for k in (4, 11, 12, 13, 25)]
        for name in bounded:
            hinges[name]["Limits"] = {"Lower": 0.}
        _, bodies = run(limited(solids, hinges, 1e-7, 1e-7))
        rows = np.zeros((2 * (n - 1), 3 * n))
        for k in range(n - 1):  # the right end of one moves as the left end of the next
            rows[2 * k, [3 * k, 3 * k + 3]] = 1, -1
            rows[2 * k + 1, [3 * k + 1, 3 * k + 2, 3 * k + 4, 3 * k + 5]] = 1, .5, -1, .5
        limits = np.zeros((len(bounded), 3 * n))
        for row, name in zip(limits, bounded):
            k = int(name[1:])
            row[[3 * k - 1, 3 * k + 2]] = -1, 1
        inverse = np.diag([1., 1., 12 / 1.04] * n)
        start = np.zeros(3 * n)
        start[2::3] = spins

        def motion(held):
            return start - inverse @ held.T @ np.linalg.solve(held @ inverse @ held.T, held @ start)
        acts = np.zeros(len(bounded), bool)
        for _ in range(20):
            held = np.vstack([rows, limits[acts]])
            velocity = motion(held)
            pushes = np.linalg.solve(held @ inverse @ held.T, -held @ start)[len(rows):]
            wrong = limits @ velocity < -1e-12
            wrong[np.flatnonzero(acts)] = pushes < 0
            if not wrong.any():
                break
            acts ^= wrong
        self.assertFalse(wrong.any())
        self.assertTrue(0 < acts.sum() < len(bounded))
        for k in range(n):
            self.assertAlmostEqual(bodies[f"L{k}"][-1]["wz"], velocity[3 * k + 2], delta=1e-5)

    def test_limits_take_energy_and_give_none(self):
        """A tossed chain whose hinges all reach their limits: strictly so with impulses at the end of steps, else they do
        not add to the swing that energy has without them."""
        solids, free = links(4, (2., -3., 4., -1.))
        hinges = {name: {**hinge, "Limits": {"Lower": -.4, "Upper": .4}} for name, hinge in free.items()}

        def gain(joints):
            kinetic = energy(*run(limited(solids, joints, step, 2.)), 0.)
            return kinetic[-1] / kinetic[0], (kinetic - np.minimum.accumulate(kinetic)).max() / kinetic[0]
        for step in (.02, .1, .5):
            history, bodies = run(limited(solids, hinges, step, 60 * step, impulses="end of step"))
            self.assertLess(np.diff(energy(history, bodies, 0.)).max(), 1e-12)
        for step in (.02, .01):
            left, gained = gain(hinges)
            self.assertLess(left, .1)
            self.assertLess(gained, gain(free)[1])

    def test_a_spring_pushes_against_a_limit_in_vain(self):
        rows = joints_of(arm(.05, 3., 0., Control="proportional derivative", Stiffness=4., Damping=1.,
                             **{"Limits": {"Upper": .25}, "Target": {"Type": "constant", "Value": 1.}}))["H"]
        self.assertAlmostEqual(rows[-1]["q"], .25, delta=1e-9)
        self.assertAlmostEqual(rows[-1]["torque"], 4. * .75, delta=1e-6)

    def test_a_ball_turns_so_far_about_any_axis(self):
        solids = {"A": {**unseen_box((0., 0., 0.), (1., 2., -1.)), "Geometry": {"Shape": "box", "Size": (.5, .3, .4)}}}
        rows = joints_of(limited(solids, {"S": joint("ball", ("space", "A"), (.1, .2, 0.), **{"Limits": {"Upper": .7}})}, .02, 2.))
        turns = [math.sqrt(sum(rows[f"S {k}"][n]["q"] ** 2 for k in (1, 2, 3))) for n in range(len(rows["S 1"]))]
        self.assertLess(max(turns), .7 + 1e-3)
        self.assertGreater(max(turns), .7 - 1e-9)

    def test_every_coordinate_has_its_own(self):
        """A cylinder slides and turns, a universal joint turns about two axes: one is stopped, the other goes on."""
        solids = {"A": {**unseen_box((0., 0., 0.), (0., 0., 1.)), "Velocity": (0., 0., .5)}}
        along = joint("cylinder", ("space", "A"), (0., 0., 0.), Axis=(0., 0., 1.),
                      **{"Limits": {"Lower": (-.1, -.2), "Upper": (.1, 50.)}})
        rows = joints_of(limited(solids, {"C": along}, .02, 1.))
        self.assertAlmostEqual(rows["C 1"][-1]["q"], .1, delta=1e-9)
        self.assertAlmostEqual(rows["C 2"][-1]["q"], 1., delta=1e-9)
        solids = {"A": unseen_box((0., 0., 0.), (.7, 0., .4))}
        cross = joint("universal", ("space", "A"), (0., 0., 0.), Axis=(1., 0., 0.), **{"Second Axis": (0., 0., 1.)},
                      **{"Limits": {"Lower": (-.1, -.2), "Upper": (.2, 50.)}})
        rows = joints_of(limited(solids, {"U": cross}, .02, 1.))
        self.assertAlmostEqual(rows["U 1"][-1]["q"], .2, delta=1e-6)
        self.assertGreater(rows["U 2"][-1]["q"], .3)

    def test_loops_have_limits(self):
        """A square of four links whose rates depend on one another stops where one of them does."""
        places = {"A": (.5, 0.), "B": (1., .5), "C": (.5, 1.), "D": (0., .5)}
        spins = {"A": 0., "B": -1., "C": 0., "D": -1.}
        solids = {name: {**unseen_box(places[name], spins[name]), "Rotation": 0. if name in "AC" else math.pi / 2}
                  for name in places}
        corners = {"AB": (1., 0.), "BC": (1., 1.), "CD": (0., 1.), "DA": (0., 0.)}
        hinges = {name: joint("hinge", tuple(name), corner) for name, corner in corners.items()}
        hinges["CD"].update({"Limits": {"Lower": -.3, "Upper": .3}})
        rows = joints_of(limited(solids, hinges, .02, 2.))
        self.assertAlmostEqual(max(abs(row["q"]) for row in rows["CD"]), .3, delta=1e-6)
        self.assertAlmostEqual(abs(rows["CD"][-1]["q"]), .3, delta=1e-6)

    def test_a_motor_that_goes_past_its_limit_troubles_nobody(self):
        """No impulse can hold it: what is wrong there is no measure of what may be wrong elsewhere."""
        solids, hinges = links(6)
        for hinge in hinges.values():
            hinge.update({"Limits": {"Lower": -.06, "Upper": .06}})
        _, alone = run(limited(solids, hinges, .02, .5, GRAVITY))
        mill = {"Left": unseen_box((0., 9.5), 0.), "Top": unseen_box((.5, 10.), 0.), "Right": unseen_box((1., 9.5), 0.)}
        for name in ("Left", "Right"):
            mill[name]["Rotation"] = math.pi / 2
        swing = {"Type": "sinusoid", "Amplitude": .8, "Frequency": 1.}
        bars = {"M0": joint("hinge", ("space", "Left"), (0., 9.), Control="prescribed", Target=swing),
                "M1": joint("hinge", ("Left", "Top"), (0., 10.)), "M3": joint("hinge", ("Right", "space"), (1., 9.)),
                "M2": joint("hinge", ("Top", "Right"), (1., 10.), **{"Limits": {"Lower": -.01, "Upper": .01}})}
        both = limited({**mill, **solids}, {**bars, **hinges}, .02, .5, GRAVITY)
        _, beside = run(both)
        for name, rows in alone.items():
            for row, other in zip(rows, beside[name]):
                self.assertAlmostEqual(row["y"], other["y"], delta=1e-9)
        self.assertGreater(max(row["q"] for row in joints_of(both)["M2"]), .5)

    def test_restart_at_a_limit(self):
        solids, hinges = links(3)
        for hinge in hinges.values():
            hinge.update({"Limits": {"Lower": -.3, "Upper": .3}})
        scene = limited(solids, hinges, .02, .6, GRAVITY)
        with tempfile.TemporaryDirectory() as folder:
            _, straight = run(scene, folder=folder)
        with tempfile.TemporaryDirectory() as folder:
            history, _ = run(scene, arguments=["--steps", "20"], folder=folder)
            self.assertGreater(history[-1]["contacts"], 0)
            _, again = run(scene, arguments=["--restart", f"{folder}/output/checkpoint-000020.h5"], folder=folder)
        for name in solids:
            self.assertEqual(straight[name][-1], again[name][-1])

    def test_the_ledger_knows_limits_and_walls(self):
        """In water: a bob on two arms in space swings against its limit and, without that, against a wall."""
        ball = {"Type": "rigid body", "Geometry": {"Shape": "ball", "Radius": .08}, "Density": 5000., "Position": (.6, .62)}
        rod = {**unseen_box((.4, .62), 0., 3.), "Geometry": {"Shape": "box", "Size": (.3, .05)}}
        last = {}
        for limit in (-.3, -9.):
            for ranks in (1, 2, 4):
                hinges = {"A": joint("hinge", ("space", "Rod"), (.25, .62), **{"Limits": {"Lower": limit}}),
                          "B": joint("hinge", ("Rod", "Ball"), (.55, .62), **{"Limits": {"Lower": -.5, "Upper": .5}})}
                scene = tank({"Rod": rod, "Ball": ball}, hinges, "flux", step=.02, end=.9)
                scene["Contact"] = {"Type": "gauss seidel"}
                history, bodies = run(scene, ranks)
                self.assertGreater(sum(row["contacts"] for row in history), 0)
                self.assertLess(max(row["momentum_error"] for row in history), 1e-11)
                self.assertLess(max(row["angular_momentum_error"] for row in history), 1e-11)
                last.setdefault(limit, []).append(bodies["Ball"][-1])
        for rows in last.values():
            for row in rows[1:]:
                self.assertAlmostEqual(row["x"], rows[0]["x"], delta=1e-8)


if __name__ == "__main__":
    unittest.main()
