"""Time/Order in Time 2, both solves of a step kept: how a floating disc swings does not depend on the step, bodies that touch rest, turning
bodies keep their momenta, books are closed, and neither ranks nor a restart change anything."""
import math
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from scene_xml import xml  # noqa: E402
from simulation import attempt, column, histories, simulate, table, without_times  # noqa: E402

R, G = .1, 9.81


def scene(solids, step, order=2, dimension=2, cells=(64, 64), level=True, **more):
    fluid = {"Density": 1000., "Gravity": (0.,) * (dimension - 1) + (-G,)}
    if level:
        fluid["Free Surface"] = {"Liquid": {"Pool": {"Type": "level", "Height": 0.}}}
    return xml("Scene", {"Dimension": dimension, "Domain": {"Lower": (-8 * R,) * dimension, "Upper": (8 * R,) * dimension, "Cells": cells},
                         "Fluid": fluid, "Solids": solids, "Coupling": {"Type": "flux"}, "Solver": {"Tolerance": 1e-9},
                         "Time": {"Order in Time": order, "End": 100., "Fixed Step": step}, "Output": {"Frames": False}, **more})


def disc(density, position, **more):
    return {"Type": "rigid body", "Geometry": {"Shape": "ball", "Radius": R}, "Density": density, "Position": position, **more}


class SecondOrder(unittest.TestCase):
    def test_a_floating_disc_swings_alike_at_any_step(self):
        """Let go a tenth of R above its draft; its first trough, over that. With order 1 the longer of two steps takes
        more than a twentieth of it away."""
        def trough(order, step):
            step *= math.sqrt(R / G)
            history, bodies = histories(scene({"Disc": disc(500., (0., .1 * R))}, step, order), "--steps", round(4 * math.sqrt(R / G) / step))
            self.assertLess(max(column(history, "momentum_error")), 1e-14)
            return min(column(bodies, "y")) / (.1 * R)
        self.assertAlmostEqual(trough(2, .2), trough(2, .05), delta=.015)
        self.assertGreater(trough(1, .2) - trough(1, .05), .06)

    def test_what_touches_rests(self):
        """A stone on the floor of a tank, and a light ball under a lid that is held: two solves a kick and no motion."""
        box = {"Type": "rigid body", "Geometry": {"Shape": "box", "Size": (3 * R, 2 * R)}, "Position": (0., -7 * R), "Density": 2000.}
        for solids in ({"Stone": box}, {"Cork": disc(500., (0., -5 * R)), "Lid": {**box, "Position": (0., -3 * R), "Motion": {"Type": "static"}}}):
            with self.subTest(list(solids)[0]):
                history, bodies = histories(scene(solids, .01, Coupling={"Type": "mixed face"}), "--steps", 20)
                self.assertLess(max(abs(value) for name in ("vx", "vy") for value in column(bodies, name)[-len(solids):]), 1e-6)
                self.assertLess(column(history, "fluid_kinetic_energy")[-1], 1e-9)

    def test_what_overlaps_is_pushed_out_and_stays(self):
        """Two discs that overlap at the start by a fifth of R, without weight: apart after twenty steps of up to 7 cm/s, of which
        no speed is left but that of water swept along."""
        text = scene({"One": disc(2000., (-.9 * R, 0.)), "Other": disc(2000., (.9 * R, 0.))}, .01, level=False)
        _, bodies = histories(text.replace('"{0.0, -9.81}"', '"{0.0, 0.0}"'), "--steps", 20)
        one, other = column(bodies, "x")[-2:]
        self.assertGreater(other - one, 1.98 * R)
        self.assertLess(max(map(abs, column(bodies, "vx"))), .005)

    def test_turning_bodies_keep_their_momenta(self):
        """A box that turns about an axis that is none of its own, in vacuum: angular momentum to round-off, energy to second order."""
        box = {"Box": {"Type": "rigid body", "Geometry": {"Shape": "box", "Size": (R, 2 * R, 3 * R)}, "Position": (0., 0., 0.), "Density": 500.,
                       "Angular Velocity": (1., 2., .5), "Seen by Fluid": False}}
        history, bodies = histories(scene(box, .05, dimension=3, cells=(8, 8, 8), level=False, Contact={"Type": "none"}), "--steps", 60)
        self.assertLess(max(column(history, "angular_momentum_error")), 1e-13)
        energy = column(history, "solid_kinetic_energy")
        fall = [.5 * row * row for row in column(bodies, "vz")]
        mass = 500. * 6 * R ** 3
        spin = [total - mass * own for total, own in zip(energy, fall)]
        self.assertLess(max(spin) / min(spin) - 1, 1e-6)

    def test_the_budget_of_energy_is_closed(self):
        """Each kick keeps its own books; nothing is left over of what both gave."""
        text = scene({"Disc": disc(500., (0., .1 * R))}, .01, Observers={"Budget": {"Type": "energy"}})
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            (folder / "scene.xml").write_text(text)
            simulate(folder / "scene.xml", folder / "output", "--steps", 20)
            budget, history = table(folder / "output/Budget.csv"), table(folder / "output/history.csv")
        moved = max(map(abs, column(budget, "loads")))
        self.assertLess(max(map(abs, column(budget, "left"))), 1e-9 * moved)
        energy = column(history, "fluid_kinetic_energy")[-1] + column(history, "solid_kinetic_energy")[-1]
        self.assertLess(abs(column(budget, "kinetic_change")[-1] - energy), 1e-9 * moved)

    def test_a_disc_sinks_as_fast_in_honey(self):
        """The viscous solve reads the pressure of the last half step: with that of another length a disc would be held or pulled by it. Steps of 2 and of
        .2 nu dt / h^2, between walls."""
        def speed(order, step):
            text = scene({"Disc": disc(1500., (0., .5 * R))}, step, order, level=False)
            text = text.replace('<Parameter name="Density" type="double" value="1000.0"/>', '<Parameter name="Density" type="double" value="1000.0"/>\n'
                                '<Parameter name="Viscosity" type="double" value="50."/>', 1)
            _, bodies = histories(text, "--steps", round(.2 / step))
            return column(bodies, "vy")[-1]
        fine = speed(1, .0025)
        self.assertAlmostEqual(speed(2, .0025) / fine, 1, delta=.01)
        self.assertAlmostEqual(speed(2, .025) / fine, 1, delta=.03)

    def check_restart(self, text, history):
        """A run that is cut off after four of eight steps goes on as the whole one did, to the bit."""
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            (folder / "scene.xml").write_text(text)
            simulate(folder / "scene.xml", folder / "output", "--steps", 4)
            simulate(folder / "scene.xml", folder / "output", "--steps", 8, "--restart", folder / "output/checkpoint-000004.h5")
            self.assertEqual(without_times(table(folder / "output/history.csv")), without_times(history))

    def test_ranks_and_restarts(self):
        text = scene({"Disc": disc(500., (.03, .1 * R))}, .02)
        whole = histories(text, "--steps", 8)
        apart = histories(text, "--steps", 8, ranks=2)
        for name in ("x", "y", "vx", "vy"):
            self.assertAlmostEqual(column(whole[1], name)[-1], column(apart[1], name)[-1], delta=1e-9)
        self.check_restart(text, whole[0])

    def test_a_jointed_body_restarts_and_keeps_its_hinge(self):
        """A disc on a nail in a full tank: the rate by advection is in the checkpoint, joints close at every step."""
        nail = {"Nail": {"Type": "hinge", "Solids": ("space", "Disc"), "Point": (0., 0.)}}
        text = scene({"Disc": disc(3000., (3 * R, 0.))}, .01, level=False, Joints=nail)
        whole = histories(text, "--steps", 8)
        for x, y in zip(column(whole[1], "x"), column(whole[1], "y")):
            self.assertAlmostEqual(math.hypot(x, y), 3 * R, delta=1e-12)
        self.check_restart(text, whole[0])

    def test_vortices_stay_as_they_are(self):
        """Taylor and Green's, without viscosity, are a steady flow. A body that no fluid sees makes the steps those of two kicks:
        their first one has to find the pressure that bends the way of the fluid, or a third of the energy is gone after 1 s."""
        stone = {"Stone": disc(1., (.5, .5), **{"Seen by Fluid": False})}
        lost = []
        for step in (.05, .025, .0125):
            flow = xml("Scene", {
                "Dimension": 2, "Solids": stone, "Contact": {"Type": "none"}, "Output": {"Frames": False}, "Time": {"End": 1., "Fixed Step": step},
                "Domain": {"Cells": (32, 32), "Sides": {f"{axis} {end}": {"Type": "periodic"} for axis in "xy" for end in ("lower", "upper")}},
                "Fluid": {"Density": 1., "Velocity": ("sin(2*_pi*x)*cos(2*_pi*y)", "-cos(2*_pi*x)*sin(2*_pi*y)")}})
            history, _ = histories(flow)
            lost.append(1 - column(history, "fluid_kinetic_energy")[-1] / .25)
        self.assertLess(lost[0], .06)
        self.assertLess(lost[2], .011)
        self.assertGreater(math.log2(lost[0] / lost[1]), 1.3)

    def test_what_it_does_not_know_is_refused(self):
        soft = {"Soft": {"Type": "deformable body", "Geometry": {"Shape": "box", "Size": (2 * R, 2 * R), "Mesh Spacing": R}, "Position": (0., 0.),
                         "Density": 900.,
                         "Material": {"Young's Modulus": 1e4}}}
        gas = scene({"Disc": disc(500., (0., 0.))}, .01).replace('<ParameterList name="Liquid">', '<Parameter name="Trapped Air" type="string" value="ideal gas"/>\n<ParameterList name="Liquid">')
        for text, word in ((scene(soft, .01), "deforms"), (gas, "gas")):
            with tempfile.TemporaryDirectory() as name:
                (Path(name) / "scene.xml").write_text(text)
                failed = attempt(Path(name) / "scene.xml", Path(name) / "output")
                self.assertEqual(failed.returncode, 2)
                self.assertIn(word, failed.stdout)


if __name__ == "__main__":
    unittest.main()
