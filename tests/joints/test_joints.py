"""Joints between rigid bodies. In vacuum (bodies that no fluid sees) against the equations of motion and what they
conserve; in water against solids that need no joints; on one rank and on two."""
import math
import tempfile
import unittest

import free_chain
import numpy as np
from jointed_scene import joint, run, tank, unseen_box, vacuum

CHAIN = {name: unseen_box((float(k - 1), 0.), spin) for k, (name, spin) in enumerate(zip("ABC", free_chain.SPINS))}
CHAIN_JOINTS = {"AB": joint("hinge", ("A", "B"), (-.5, 0.)), "BC": joint("hinge", ("B", "C"), (.5, 0.))}
AXIS = {"Axis": (0., 0., 1.)}


def chain(step, end=2., impulses="two halves", turn=100.):
    return run(vacuum(CHAIN, CHAIN_JOINTS, step, end, impulses, turn))


def energies(history):
    return np.array([row["solid_kinetic_energy"] for row in history])


def angular_momentum(bodies):
    inertia = free_chain.MASSES[2, 2]
    last = [rows[-1] for rows in bodies.values()]
    return sum(row["x"] * row["vy"] - row["y"] * row["vx"] + inertia * row["wz"] for row in last)


class InVacuum(unittest.TestCase):
    def test_two_halves_are_of_second_order(self):
        exact, _ = free_chain.state(2.)
        errors = []
        for step in (.1, .05, .025):
            _, bodies = chain(step)
            last = np.array([[bodies[name][-1][axis] for axis in "xy"] for name in "ABC"])
            errors.append(np.abs(last - exact.reshape(3, 3)[:, :2]).max())
        self.assertLess(errors[0], .02)
        for coarse, fine in zip(errors, errors[1:]):
            self.assertGreater(math.log2(coarse / fine), 1.9)

    def test_two_halves_keep_energy_and_momentum(self):
        _, start = free_chain.start()
        moment = 2 / 12 * 1.3  # sum of m x vy + I w, the same before and after the joints act
        for step, bound in ((.1, .02), (.05, .005)):
            history, bodies = chain(step, end=10.)
            change = energies(history) / free_chain.energy(start) - 1
            self.assertLess(np.abs(change).max(), bound)
            self.assertAlmostEqual(angular_momentum(bodies), moment, delta=1e-12)
            self.assertLess(max(row["angular_momentum_error"] for row in history), 1e-12)

    def test_energy_is_kept_for_two_thousand_steps(self):
        """At up to a fifth of a radian a step, of one length. Where that turn sets each step, energy is lost slowly: a tenth
        at .2 rad, a hundredth at .1."""
        _, start = free_chain.start()
        history, bodies = run(vacuum(CHAIN, CHAIN_JOINTS, .1, 1e9), arguments=["--steps", "2000"])
        change = energies(history) / free_chain.energy(start) - 1
        self.assertLess(np.abs(change).max(), .03)
        self.assertGreater(.1 * max(abs(row["wz"]) for rows in bodies.values() for row in rows), .19)
        history, _ = run(vacuum(CHAIN, CHAIN_JOINTS, 1., 1e9, turn=.1), arguments=["--steps", "2000"])
        change = energies(history) / free_chain.energy(start) - 1
        self.assertLess(np.abs(change).max(), .03)

    def test_end_of_step_never_gains(self):
        _, start = free_chain.start()
        for step in (.1, .5, 2.):
            history, _ = chain(step, 40 * step, "end of step")
            change = np.diff(np.concatenate([[free_chain.energy(start)], energies(history)]))
            self.assertLess(change.max(), 1e-12)

    def test_long_steps_lose_energy(self):
        """Above half a radian a step all of the impulse acts at its end."""
        history, _ = chain(1., 40.)
        self.assertLess(energies(history).max(), free_chain.energy(free_chain.start()[1]))

    def test_the_step_is_bounded_by_the_turn(self):
        history, bodies = chain(.1, 4., turn=.05)
        turns = [step["dt"] * max(abs(bodies[name][k]["wz"]) for name in "ABC")
                 for k, step in enumerate(history[1:])]
        self.assertLess(max(turns), .05 * (1 + 1e-9))
        self.assertGreater(max(turns), .049)

    def test_joints_stay_closed(self):
        """Distances of the hinge from both boxes' middles: as long as the arms, however they turn."""
        scene = vacuum({"A": CHAIN["A"]}, {"H": joint("hinge", ("space", "A"), (-.5, 0.))}, .05, 5.)
        _, bodies = run(scene)
        for row in bodies["A"]:
            self.assertAlmostEqual(math.hypot(row["x"] + .5, row["y"]), .5, delta=1e-12)

    def test_balls_in_space(self):
        spins = ((.5, .7, 1.), (0., -.6, -1.), (.3, .4, 1.5))
        solids = {name: unseen_box((k - 1., 0., 0.), spin) for k, (name, spin) in enumerate(zip("ABC", spins))}
        joints = {"AB": joint("ball", ("A", "B"), (-.5, 0., 0.)), "BC": joint("ball", ("B", "C"), (.5, 0., 0.))}
        swings = []
        for step in (.1, .05):
            history, _ = run(vacuum(solids, joints, step, 5.))
            energy = energies(history)
            swings.append(np.ptp(energy) / energy[0])
        self.assertLess(swings[0], .02)
        self.assertGreater(math.log2(swings[0] / swings[1]), 1.5)

    def test_a_loop_with_more_rows_than_it_needs(self):
        """Four links in a square, in space: 20 rows, of which 3 say nothing new."""
        spin = {"A": (.1, .2, .5), "B": (.1, .2, -1.2), "C": (0., 0., 0.), "D": (0., 0., 0.)}
        places = {"A": (.5, 0., 0.), "B": (1., .5, 0.), "C": (.5, 1., 0.), "D": (0., .5, 0.)}
        solids = {name: unseen_box(places[name], spin[name], mass) for name, mass in zip("ABCD", (1., 2., 1., 1.))}
        corners = {"AB": (1., 0., 0.), "BC": (1., 1., 0.), "CD": (0., 1., 0.), "DA": (0., 0., 0.)}
        joints = {name: joint("hinge", tuple(name), corner, **AXIS) for name, corner in corners.items()}
        history, bodies = run(vacuum(solids, joints, .05, 5.))
        energy = energies(history)
        self.assertLess(np.ptp(energy) / energy[0], 1e-3)
        ends = []
        for step in (.1, .05, .025, .0125):
            _, own = run(vacuum(solids, joints, step, 2.))
            ends.append(np.array([own[name][-1][axis] for name in "ABCD" for axis in ("x", "y", "z", "wx", "wy", "wz")]))
        apart = [np.abs(a - b).max() for a, b in zip(ends, ends[1:])]
        for coarse, fine in zip(apart, apart[1:]):
            self.assertGreater(math.log2(coarse / fine), 1.9)
        for row, other in zip(bodies["A"], bodies["C"]):  # opposite links of a parallelogram turn alike
            for axis in ("wx", "wy", "wz"):
                self.assertAlmostEqual(row[axis], other[axis], delta=1e-9)


BOX = {"Type": "rigid body", "Geometry": {"Shape": "box", "Size": (.4, .12)}, "Density": 300., "Orientation": 0.}
HALF = {**BOX, "Geometry": {"Shape": "box", "Size": (.2, .12)}, "Seen by Fluid": False}
WELDS = {"left": joint("weld", ("Hull", "Left"), (.4, .5)), "right": joint("weld", ("Left", "Right"), (.5, .5))}


def parts(turn):
    """A hull of no weight that the fluid sees, with what weighs as much as the whole in two parts inside."""
    along = np.array([math.cos(turn), math.sin(turn)]) * .1
    return {"Hull": {**BOX, "Density": 1e-6, "Position": (.5, .5), "Orientation": turn},
            "Left": {**HALF, "Position": tuple(np.array((.5, .5)) - along), "Orientation": turn},
            "Right": {**HALF, "Position": tuple(np.array((.5, .5)) + along), "Orientation": turn}}


class InWater(unittest.TestCase):
    def test_welded_parts_are_the_whole(self):
        whole = {"Whole": {**BOX, "Position": (.5, .5), "Density": 300.000001}}
        for coupling, viscosity in (("flux", 0.), ("mixed face", 1.)):
            expected, bodies = run(tank(whole, {}, coupling, viscosity))
            for impulses in ("two halves", "end of step"):
                for ranks in (1, 2):
                    history, jointed = run(tank(parts(0.), WELDS, coupling, viscosity, Impulses=impulses), ranks)
                    for axis in ("x", "y", "vx", "vy", "wz"):
                        self.assertAlmostEqual(jointed["Hull"][-1][axis], bodies["Whole"][-1][axis], delta=1e-9)
                    self.assertLess(max(row["momentum_error"] for row in history), 1e-13)
                    self.assertLessEqual(history[-1]["s2_iterations"], expected[-1]["s2_iterations"] + 1)

    def test_contact_leaves_alone_what_joints_let_not_part(self):
        """The outer two of three overlap, and no impulse between them moves anything."""
        boxes = {name: {**BOX, "Position": (.5 + x, .5 + y), "Orientation": .1 * k}
                 for k, (name, x, y) in enumerate((("A", -.05, 0.), ("B", 0., .03), ("C", .06, -.02)))}
        welds = {"left": joint("weld", ("A", "B"), (.4, .5)), "right": joint("weld", ("B", "C"), (.5, .5))}
        scene = tank(boxes, welds, "mixed face")
        _, free = run(scene)
        history, bodies = run({**scene, "Contact": {"Type": "gauss seidel"}})
        self.assertGreater(min(row["deepest_overlap"] for row in history), .01)
        self.assertLess(max(row["momentum_error"] for row in history), 1e-12)
        for name in boxes:
            for axis in ("x", "y", "vx", "vy", "wz"):
                self.assertAlmostEqual(bodies[name][-1][axis], free[name][-1][axis], delta=1e-9)

    def test_welded_parts_that_turn_do_so_to_second_order(self):
        whole = {"Whole": {**BOX, "Position": (.42, .5), "Density": 300.000001, "Orientation": .3}}
        shifted = {name: {**body, "Position": tuple(np.array(body["Position"]) - (.08, 0.))}
                   for name, body in parts(.3).items()}
        errors = []
        for step in (.02, .01):
            _, bodies = run(tank(whole, {}, "flux", step=step, end=.3))
            _, jointed = run(tank(shifted, WELDS, "flux", step=step, end=.3))
            errors.append(abs(jointed["Hull"][-1]["wz"] - bodies["Whole"][-1]["wz"]))
        self.assertGreater(abs(bodies["Whole"][-1]["wz"]), .3)
        self.assertLess(errors[1], 1e-3)
        self.assertGreater(math.log2(errors[0] / errors[1]), 1.5)

    def test_a_body_cut_in_two_is_the_whole(self):
        """Both halves seen by the fluid, welded where they meet without a gap. Along the lattice for ten steps, on 1, 2
        and 4 ranks; aslant for one, since bodies that turn part with the square of the step, and without the correction
        of buoyancy, which half a body has no whole columns for."""
        def whole(turn):
            return {"Whole": {**BOX, "Position": (.5, .5), "Orientation": turn}}

        def halves(turn):
            along = np.array([math.cos(turn), math.sin(turn)]) * .1
            half = {**HALF, "Seen by Fluid": True, "Orientation": turn}
            return {"Left": {**half, "Position": tuple(np.array((.5, .5)) - along)},
                    "Right": {**half, "Position": tuple(np.array((.5, .5)) + along)}}
        for turn, viscosity, end, ranks in ((0., 0., .1, (1, 2, 4)), (0., 1., .1, (1,)), (.3, 0., .01, (1, 2)), (.7, 0., .01, (1,))):
            scenes = [tank(whole(turn), {}, "flux", viscosity, end=end),
                      tank(halves(turn), {"weld": WELDS["right"]}, "flux", viscosity, end=end)]
            for scene in scenes:
                scene["Coupling"]["Correct Buoyancy"] = turn == 0
            _, bodies = run(scenes[0])
            for n in ranks:
                _, cut = run(scenes[1], n)
                left, right, expected = cut["Left"][-1], cut["Right"][-1], bodies["Whole"][-1]
                for axis in ("x", "y", "vx", "vy"):
                    self.assertAlmostEqual((left[axis] + right[axis]) / 2, expected[axis], delta=1e-11)
                self.assertAlmostEqual(left["wz"], expected["wz"], delta=1e-10)

    def test_a_hinge_to_space_is_a_pivot(self):
        """In the first step; then their momenta are carried along differently."""
        arm = np.array([math.sin(.6), -math.cos(.6)]) * .25
        ball = {"Type": "rigid body", "Geometry": {"Shape": "ball", "Radius": .1}, "Density": 2500.,
                "Position": tuple(np.array((.5, .75)) + arm)}
        pinned = {**ball, "Pivot": tuple(-arm), "Locked": ("x", "y")}
        hinge = {"H": joint("hinge", ("space", "Ball"), (.5, .75))}
        for coupling in ("flux", "mixed face"):
            _, expected = run(tank({"Ball": pinned}, {}, coupling, end=.01))
            for impulses, bound in (("two halves", 1e-4), ("end of step", 1e-10)):
                history, bodies = run(tank({"Ball": ball}, hinge, coupling, end=.01, Impulses=impulses))
                self.assertAlmostEqual(bodies["Ball"][-1]["wz"], expected["Ball"][-1]["wz"], delta=bound)
                self.assertLess(max(row["momentum_error"] for row in history), 1e-13)

    def test_a_spring_moves_a_piston_and_its_water(self):
        """Across a duct that is open at both ends. What mass the water adds is told by a force on the free piston; with
        that the first step from rest is known: the spring is that of the middle of the step."""
        stiffness, way, step = 2e5, .05, .01

        def first_step(impulses, force=0., **control):
            piston = {"Type": "rigid body", "Geometry": {"Shape": "box", "Size": (.25, 1.2)}, "Mass": 400., "Position": (.51, .5),
                      "Force": (force, 0.)}
            slider = joint("slider", ("space", "Piston"), (.5, .5), Axis=(1., 0.), **control)
            scene = tank({"Piston": piston}, {"S": slider}, "flux", step=step, end=step, Impulses=impulses)
            scene["Fluid"]["Gravity"] = (0., 0.)
            scene["Domain"]["Sides"] = {side: {"Type": "open"} for side in ("x lower", "x upper")}
            last = run(scene)[1]["Piston"][-1]
            return last["x"] - .51, last["vx"]
        spring = {"Control": "proportional derivative", "Stiffness": stiffness, "Target": {"Type": "constant", "Value": way}}
        force = stiffness * way
        for impulses in ("two halves", "end of step"):
            way_by_force, _ = first_step(impulses, force)
            mass = step ** 2 / 2 * force / way_by_force
            self.assertTrue(1100 < mass < 1160)  # 400 and two columns of .75 together
            way_by_spring, speed = first_step(impulses, **spring)
            self.assertAlmostEqual(way_by_spring, step ** 2 / 2 * force / (mass + step ** 2 / 4 * stiffness), delta=1e-12)
            # Where the piston is then, the columns are others by what a cell sees of that.
            self.assertAlmostEqual(speed, step * force / (mass + step ** 2 / 2 * stiffness), delta=1e-3 * speed)

    def test_a_prescribed_body_carries_others(self):
        """A bob hangs on a trolley that rolls to and fro: the hinge goes along, and the ledger knows who pulls."""
        trolley = {"Type": "rigid body", "Geometry": {"Shape": "box", "Size": (.1, .05)}, "Position": (.5, .85),
                   "Motion": {"Type": "sinusoid", "Amplitude": (.1, 0.), "Frequency": 1.}}
        bob = {"Type": "rigid body", "Geometry": {"Shape": "ball", "Radius": .1}, "Density": 3000., "Position": (.5, .5)}
        hinge = {"H": joint("hinge", ("Trolley", "Bob"), (.5, .85))}
        for ranks in (1, 2):
            history, bodies = run(tank({"Trolley": trolley, "Bob": bob}, hinge, "flux", step=.02, end=.4), ranks)
            for cart, ball in zip(bodies["Trolley"], bodies["Bob"]):
                self.assertAlmostEqual(math.hypot(ball["x"] - cart["x"], ball["y"] - cart["y"]), .35, delta=1e-11)
            self.assertLess(max(row["momentum_error"] for row in history), 1e-12)
            self.assertLess(max(row["angular_momentum_error"] for row in history), 1e-12)

    def test_restart(self):
        solids = parts(.3)
        solids["Hull"]["Density"] = 200.
        scene = tank(solids, {"left": joint("hinge", ("Hull", "Left"), (.4, .5)), "right": WELDS["right"]}, "flux",
                     end=.2)
        with tempfile.TemporaryDirectory() as folder:
            _, straight = run(scene, folder=folder)
        with tempfile.TemporaryDirectory() as folder:
            run(scene, arguments=["--steps", "7"], folder=folder)
            _, again = run(scene, arguments=["--restart", f"{folder}/output/checkpoint-000007.h5"], folder=folder)
        self.assertEqual(straight["Hull"][-1], again["Hull"][-1])


if __name__ == "__main__":
    unittest.main()
