"""Joints between rigid bodies. In vacuum (bodies that no fluid sees) against the equations of motion and what they
conserve; in water against solids that need no joints; on one rank and on two."""
import math
import tempfile
import unittest

import free_chain
import numpy as np
from joint_cases import (BALL_CHAIN, BOX, CHAIN, CHAIN_JOINTS, CHAIN_MOMENT, WELDS, WHOLE, ball_chain, chain, chain_changes, chain_error,
                         chain_moment, cut_in_two, difference_of_halves, energies, parts, pivoted, square, square_end,
                         sprung_piston)
from jointed_scene import in_order, joint, joints_of, run, summary_of, tank, vacuum

class InVacuum(unittest.TestCase):
    def test_two_halves_are_of_second_order(self):
        for order in (1, 2):  # orders of the scheme of time, whose second has two halves of its own
            errors = [chain_error(run(in_order(chain(step), order))[1]) for step in (.1, .05, .025)]
            self.assertLess(errors[0], .013)
            for coarse, fine in zip(errors, errors[1:]):
                self.assertGreater(math.log2(coarse / fine), 1.9)

    def test_two_halves_keep_energy_and_momentum(self):
        for order, step, bound in ((1, .1, .006), (1, .05, .00075), (2, .1, .006), (2, .05, .00075)):
            history, bodies = run(in_order(chain(step, end=10.), order))
            self.assertLess(np.abs(chain_changes(history)).max(), bound)
            self.assertAlmostEqual(chain_moment(bodies), CHAIN_MOMENT, delta=1e-12)
            self.assertLess(max(row["angular_momentum_error"] for row in history), 1e-12)

    def test_energy_is_kept_for_two_thousand_steps(self):
        """At up to a fifth of a radian a step, of one length, and where that turn sets each step."""
        history, bodies = run(chain(.1, 1e9), arguments=["--steps", "2000"])
        self.assertLess(np.abs(chain_changes(history)).max(), .002)
        self.assertGreater(.1 * max(abs(row["wz"]) for rows in bodies.values() for row in rows), .19)
        history, _ = run(chain(1., 1e9, turn=.2), arguments=["--steps", "2000"])
        self.assertLess(np.abs(chain_changes(history)).max(), .01)

    def test_end_of_step_never_gains(self):
        _, start = free_chain.start()
        for step in (.1, .5, 2.):
            history, _ = run(chain(step, 40 * step, "end of step"))
            change = np.diff(np.concatenate([[free_chain.energy(start)], energies(history)]))
            self.assertLess(change.max(), 1e-12)

    def test_long_steps_keep_energy(self):
        history, bodies = run(chain(1., 40.))
        self.assertLess(np.abs(chain_changes(history)).max(), .02)
        self.assertAlmostEqual(chain_moment(bodies), CHAIN_MOMENT, delta=1e-10)
        self.assertEqual(summary_of(chain(1., 40.))["joints"]["steps_of_end_impulses"], 0)

    def test_long_steps_of_springs_lose_energy(self):
        """Above half a radian a step all of the impulse of what is not alone acts at its end: here a spring is there, though a
        weak one."""
        scene = chain(1., 40.)
        scene["Joints"] = {**CHAIN_JOINTS, "AB": {**CHAIN_JOINTS["AB"], "Control": "proportional derivative", "Stiffness": 1e-12}}
        history, _ = run(scene)
        self.assertLess(chain_changes(history).max(), 0)
        halves = [row["two_halves"] for row in joints_of(scene)["AB"]]
        self.assertGreater(halves.count(0), 0)
        self.assertEqual(summary_of(scene)["joints"], {"steps_of_end_impulses": halves.count(0), "steps_of_limited_torques": 0})

    def test_the_step_is_bounded_by_the_turn(self):
        history, bodies = run(chain(.1, 4., turn=.05))
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
        swings = []
        for step in (.1, .05):
            history, _ = run(ball_chain(step))
            energy = energies(history)
            swings.append(np.ptp(energy) / energy[0])
        self.assertLess(swings[0], .0017)
        self.assertLess(swings[1], .00042)
        self.assertGreater(math.log2(swings[0] / swings[1]), 1.5)

    def test_whichever_solid_a_joint_names_first(self):
        """Bodies of unlike weight, the lightest in the middle and named first by one, second by the other."""
        masses = dict(zip("ABC", (3., .01, 1.)))
        solids = {name: {**one, "Mass": masses[name]} for name, one in BALL_CHAIN[0].items()}
        runs = [run(vacuum(solids, joints, .05, 2.))[1] for joints in (BALL_CHAIN[1], swapped(BALL_CHAIN[1]))]
        self.assertLess(largest_difference(*runs), 2e-9)  # solved to 1e-8

    def test_a_loop_with_more_rows_than_it_needs(self):
        history, bodies = run(square(.05))
        energy = energies(history)
        self.assertLess(np.ptp(energy) / energy[0], 1.5e-6)
        ends = [square_end(run(square(step, 2.))[1]) for step in (.1, .05, .025, .0125)]
        apart = [np.abs(a - b).max() for a, b in zip(ends, ends[1:])]
        for coarse, fine in zip(apart, apart[1:]):
            self.assertGreater(math.log2(coarse / fine), 1.9)
        for row, other in zip(bodies["A"], bodies["C"]):  # opposite links of a parallelogram turn alike
            for axis in ("wx", "wy", "wz"):
                self.assertAlmostEqual(row[axis], other[axis], delta=1e-9)


def swapped(joints):
    return {name: {**one, "Solids": one["Solids"][::-1]} for name, one in joints.items()}


def largest_difference(bodies, others):
    axes = [axis for axis in ("x", "y", "z", "vx", "vy", "vz", "wx", "wy", "wz") if axis in next(iter(bodies.values()))[0]]
    return max(abs(one[axis] - other[axis]) for name in bodies for one, other in zip(bodies[name], others[name]) for axis in axes)


class InWater(unittest.TestCase):
    def test_plates_have_water_to_push_however_they_lie(self):
        """Two thin ones on a hinge, turned by more than half a radian: along the axes too, what joints give acts at the end of
        the step, since they are not by themselves."""
        for turn in (0., .3):
            along = np.array([math.cos(turn), math.sin(turn)])
            plate = {"Type": "rigid body", "Geometry": {"Shape": "plate", "Size": (.2, 0.), "Normal": "y"}, "Surface Density": 500., "Rotation": turn}
            plates = {name: {**plate, "Position": tuple(np.array((.5, .5)) + .12 * side * along), "Angular Velocity": 40. * side}
                      for name, side in (("A", -1), ("B", 1))}
            scene = tank(plates, {"AB": joint("hinge", ("A", "B"), (.5, .5))}, "flux", step=.05, end=.05)
            self.assertEqual([row["two_halves"] for row in joints_of(scene)["AB"]], [0], turn)

    def test_whichever_solid_a_joint_names_first(self):
        """A hull of no weight, with heavy bodies inside."""
        runs = [run(tank(parts(.3), joints, "flux"))[1] for joints in (WELDS, swapped(WELDS))]
        self.assertLess(largest_difference(*runs), 1e-10)

    def test_welded_parts_are_the_whole(self):
        for coupling, viscosity in (("flux", 0.), ("mixed face", 1.)):
            expected, bodies = run(tank(WHOLE, {}, coupling, viscosity))
            for impulses in ("two halves", "end of step"):
                for ranks in (1, 2):
                    history, jointed = run(tank(parts(), WELDS, coupling, viscosity, Impulses=impulses), ranks)
                    for axis in ("x", "y", "vx", "vy", "wz"):
                        self.assertAlmostEqual(jointed["Hull"][-1][axis], bodies["Whole"][-1][axis], delta=1e-11)
                    self.assertLess(max(row["momentum_error"] for row in history), 1e-13)
                    self.assertLessEqual(history[-1]["s2_iterations"], expected[-1]["s2_iterations"] + 1)

    def test_contact_leaves_alone_what_joints_let_not_part(self):
        """The outer two of three overlap, and no impulse between them moves anything."""
        boxes = {name: {**BOX, "Position": (.5 + x, .5 + y), "Rotation": .1 * k}
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
        whole = {"Whole": {**BOX, "Position": (.42, .5), "Density": 300.000001, "Rotation": .3}}
        shifted = {name: {**body, "Position": tuple(np.array(body["Position"]) - (.08, 0.))}
                   for name, body in parts(.3).items()}
        errors = []
        for step in (.02, .005):
            _, bodies = run(tank(whole, {}, "flux", step=step, end=.3))
            _, jointed = run(tank(shifted, WELDS, "flux", step=step, end=.3))
            errors.append(abs(jointed["Hull"][-1]["wz"] - bodies["Whole"][-1]["wz"]))
        self.assertGreater(abs(bodies["Whole"][-1]["wz"]), .3)
        self.assertLess(errors[0], 1e-4)
        self.assertGreater(math.log2(errors[0] / errors[1]) / 2, 1.5)

    def test_a_body_cut_in_two_is_the_whole(self):
        """Along the lattice for ten steps, on 1, 2 and 4 ranks; aslant for one, since bodies that turn part with the
        square of the step."""
        for turn, viscosity, end, ranks in ((0., 0., .1, (1, 2, 4)), (0., 1., .1, (1,)), (.3, 0., .01, (1, 2)), (.7, 0., .01, (1,))):
            whole, halves = cut_in_two(turn, viscosity, end)
            _, bodies = run(whole)
            for n in ranks:
                _, cut = run(halves, n)
                self.assertLess(difference_of_halves(cut, bodies), 1e-11)

    def test_a_hinge_to_space_is_a_pivot(self):
        """In the first step; then their momenta are carried along differently."""
        for coupling in ("flux", "mixed face"):
            _, expected = run(pivoted(coupling))
            for impulses, bound in (("two halves", 4.5e-5), ("end of step", 1e-8)):
                history, bodies = run(pivoted(coupling, impulses))
                self.assertAlmostEqual(bodies["Ball"][-1]["wz"], expected["Ball"][-1]["wz"], delta=bound)
                self.assertLess(max(row["momentum_error"] for row in history), 1e-13)

    def test_a_spring_moves_a_piston_and_its_water(self):
        """With the mass that a force tells the first step from rest is known: the spring is that of its middle."""
        for impulses in ("two halves", "end of step"):
            mass, (way, speed), (expected_way, expected_speed) = sprung_piston(impulses)
            self.assertTrue(1100 < mass < 1160)  # 400 and two columns of .75 together
            # The part of the spring that goes over to implicit is 1e-5 here.
            self.assertAlmostEqual(way, expected_way, delta=1e-10)
            # Where the piston is then, the columns are others by what a cell sees of that.
            self.assertAlmostEqual(speed, expected_speed, delta=3e-4 * speed)

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
