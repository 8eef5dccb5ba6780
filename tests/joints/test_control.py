"""Control of joints, in vacuum: oscillators against their exact motion, prescribed ones against loads, work against
energy; in honey, where what goes to and fro gets nowhere."""
import math
import unittest

import numpy as np
from joint_cases import ARM_INERTIA as INERTIA
from joint_cases import motor_arm as arm
from joint_cases import sprung_arm as spring
from joint_cases import swimmer, swum
from jointed_scene import in_order, joint, joints_of, run, summary_of, unseen_box, vacuum

class Control(unittest.TestCase):
    def test_a_spring_takes_the_joint_to_its_target(self):
        """Critically damped: (1 + t) e^-t of the way is left."""
        for order, step, bound in ((1, .5, .005), (1, .25, .00135), (1, .125, .00033), (2, .5, .012), (2, .25, .0033), (2, .125, .00088)):
            last = joints_of(in_order(spring(step), order))["H"][-1]
            self.assertLess(abs(last["q"] - (1 - 3 * math.exp(-2))), bound)

    def test_fully_implicit_springs_are_of_first_order(self):
        errors = []
        for step in (.5, .25, .125):
            scene = in_order(spring(step), 1)
            scene["Joints"]["H"]["Point"] = (0., 0.)  # the middle of the arm: nothing but the spring acts
            scene["Articulation"]["Time Integration"] = "fully-implicit"
            found = joints_of(scene)["H"][-1]["q"]
            q = v = 0.  # the oscillator alone: the torque is that of q + dt v' in both phases
            for _ in range(round(2 / step)):
                middle = (v + step / 2 * (1 - q)) / (1 + step / 2 * (step + 2))
                v = (v + step * (1 - q)) / (1 + step * (step + 2))
                q += step * middle
            self.assertAlmostEqual(found, q, delta=1e-11)
            errors.append(abs(found - (1 - 3 * math.exp(-2))))
        self.assertTrue(.8 < math.log2(errors[1] / errors[2]) < 1.3)
        stiff = arm(.1, 2., Control="proportional derivative", Target={"Type": "constant", "Value": .3},
                    **{"Natural Frequency": 1000., "Damping Ratio": 0.})
        stiff["Articulation"]["Time Integration"] = "fully-implicit"
        self.assertAlmostEqual(joints_of(stiff)["H"][-1]["q"], .3, delta=1e-4)

    def test_stiffness_and_damping_are_gains(self):
        by_frequency = joints_of(spring(.1, .3))["H"][-1]
        by_gains = joints_of(arm(.1, 2., Control="proportional derivative", Stiffness=INERTIA, Damping=.6 * INERTIA,
                                 Target={"Type": "constant", "Value": 1.}))["H"][-1]
        self.assertAlmostEqual(by_frequency["q"], by_gains["q"], delta=1e-12)

    def test_stiff_springs_are_stable(self):
        rows = joints_of(arm(.1, 5., Control="proportional derivative", Target={"Type": "constant", "Value": .3},
                             **{"Natural Frequency": 1000., "Damping Ratio": 1.}))["H"]
        self.assertLess(max(abs(row["q"] - .3) for row in rows[-3:]), .02)
        self.assertLess(max(abs(row["q"] - .3) for row in rows), .3)

    def test_a_spring_yields_to_loads(self):
        stiffness, load = 4., 1.
        last = joints_of(arm(.1, 20., load, Control="proportional derivative", Stiffness=stiffness, Damping=2.))["H"][-1]
        self.assertAlmostEqual(last["q"], load / stiffness, delta=1e-3)
        self.assertAlmostEqual(last["torque"], -load, delta=4e-3)

    def test_torques_have_a_bound(self):
        """Short of the target the largest torque turns the arm evenly; a softer spring comes below it. Steps are counted."""
        bounded = arm(.05, 1., Control="proportional derivative", Stiffness=1e4, Damping=0.,
                      **{"Largest Torque": .1, "Target": {"Type": "constant", "Value": 3.}})
        rows = joints_of(bounded)["H"]
        self.assertTrue(all(row["limited"] == 1 for row in rows))
        self.assertAlmostEqual(rows[-1]["torque"], .1, delta=1e-10)
        self.assertAlmostEqual(rows[-1]["q"], .5 * .1 / INERTIA, delta=1e-3)
        self.assertEqual(summary_of(bounded)["joints"], {"steps_of_end_impulses": 0, "steps_of_limited_torques": 20})
        softer = spring(.05, **{"Largest Torque": .9 * INERTIA})
        rows = joints_of(softer)["H"]
        for row in rows:  # it pulls by its stiffness times the way to the target, a little less at once
            self.assertEqual(row["limited"], abs(abs(row["torque"]) - .9 * INERTIA) < 1e-9)
        bounds = [row["limited"] for row in rows]
        self.assertEqual(bounds, sorted(bounds, reverse=True))
        self.assertTrue(0 < sum(bounds) < len(bounds))
        self.assertEqual(summary_of(softer)["joints"]["steps_of_limited_torques"], sum(bounds))

    def test_a_prescribed_rate_knows_no_load(self):
        for load in (0., 30.):
            rows = joints_of(arm(.1, 2., load, Control="prescribed rate", Target={"Type": "constant", "Value": 1.},
                                 **{"Natural Frequency": 1., "Damping Ratio": 1.}))["H"]
            for row in rows:
                exact = 1 - (1 + row["time"]) * math.exp(-row["time"])
                self.assertAlmostEqual(row["q"], exact, delta=1e-10)

    def test_prescribed_joints_are_where_they_are_told(self):
        """Prescribed joints follow their targets, and the work of their torque is the energy of the system."""
        swing = {"Type": "sinusoid", "Amplitude": .5, "Frequency": .25, "Phase": 0., "Ramp Time": 1.}
        defects = []
        for step in (.05, .025):
            rows = joints_of(arm(step, 3., Control="prescribed", Target=swing))["H"]
            for row in rows:
                part = min(row["time"], 1.)
                ramp = part ** 2 * (3 - 2 * part)
                self.assertAlmostEqual(row["q"], ramp * .5 * math.sin(math.pi / 2 * row["time"]), delta=1e-11)
            work = np.cumsum([row["power"] * step for row in rows])
            energy = np.array([.5 * INERTIA * row["rate"] ** 2 for row in rows])
            defects.append(np.abs(work - energy).max() / energy.max())
        self.assertLess(defects[1], .02)
        self.assertGreater(math.log2(defects[0] / defects[1]), 1.5)

    def test_a_shaft_turns_at_a_constant_rate(self):
        """Three turns and more, after the motor has set the arm going."""
        rows = joints_of(arm(.05, 3., Control="prescribed", Target={"Type": "constant rate", "Velocity": 7.}))["H"]
        for row in rows:
            self.assertAlmostEqual(row["q"], 7 * row["time"], delta=1e-10)
            self.assertAlmostEqual(row["rate"], 7, delta=1e-10)
        self.assertLess(max(abs(row["torque"]) for row in rows[1:]), 1e-9)

    def test_a_free_pair_keeps_its_momentum_whatever_its_joint_does(self):
        solids = {"A": unseen_box((0., 0.), 0.), "B": unseen_box((1., 0.), 0.)}
        swing = {"Type": "sinusoid", "Amplitude": .5, "Frequency": .5}
        for control in ({"Control": "prescribed"}, {"Control": "proportional derivative", "Natural Frequency": 20.}):
            bend = joint("hinge", ("A", "B"), (.5, 0.), Target=swing, **control)
            _, bodies = run(vacuum(solids, {"H": bend}, .05, 2.))
            for axis in "xy":
                middle = [(a[axis] + b[axis]) / 2 for a, b in zip(bodies["A"], bodies["B"])]
                self.assertLess(np.abs(np.array(middle) - (.5 if axis == "x" else 0.)).max(), 1e-11)
            last = [rows[-1] for rows in bodies.values()]
            moment = sum((row["x"] * row["vy"] - row["y"] * row["vx"]) + 1.04 / 12 * row["wz"] for row in last)
            self.assertAlmostEqual(moment, 0, delta=1e-11)

    def test_to_and_fro_leads_nowhere_in_honey(self):
        """Two links with one hinge between them: no rhythm of one coordinate swims without inertia (Purcell's scallop).
        In water the same stroke does."""
        way = {}
        for viscosity in (1000., 1.):
            history, bodies = run(swimmer(viscosity, 3., 48))  # three cells across a link: 0.022 in water, as at 64
            way[viscosity] = swum(bodies)
            self.assertLess(max(row["momentum_error"] for row in history), 1e-12)
            self.assertGreater(np.ptp([row["y"] for row in bodies["Long"][200:]]), 2e-3)  # it does move to and fro
        self.assertLess(way[1000.], 1e-3)
        self.assertGreater(way[1.], 1e-2)

    def test_the_swimmers_ledger_closes_on_all_ranks(self):
        ends = []
        for ranks in (1, 2, 4):
            history, bodies = run(swimmer(1., .3), ranks)
            self.assertEqual(len(history), 30)
            for name in ("momentum_error", "angular_momentum_error"):
                self.assertLess(max(row[name] for row in history), 1e-12)
            ends.append([bodies[name][-1][axis] for name in ("Long", "Short") for axis in ("x", "y", "vx", "vy", "wz")])
        for one in ends[1:]:
            self.assertLess(np.abs(np.subtract(one, ends[0])).max(), 1e-7)

    def test_control_in_space(self):
        """A ball on a spring comes to its target from anywhere."""
        solids = {"A": {**unseen_box((0., 0., 0.), (1., 2., -1.)), "Geometry": {"Shape": "box", "Size": (.5, .5, .5)}}}
        target = {"Type": "constant", "Value": (.3, -.5, .8)}
        rows = joints_of(vacuum(solids, {"S": joint("ball", ("space", "A"), (0., 0., 0.), Target=target,
                                                    **{"Control": "proportional derivative", "Natural Frequency": 3.})},
                                .05, 5.))
        for k, value in enumerate(target["Value"]):
            self.assertAlmostEqual(rows[f"S {k + 1}"][-1]["q"], value, delta=1e-4)


if __name__ == "__main__":
    unittest.main()
