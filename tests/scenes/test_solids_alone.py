"""The motion of a solid depends neither on others that do not touch it, nor on the frame."""
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from scene_xml import xml  # noqa: E402
from simulation import column, simulate, table  # noqa: E402

# Elsewhere, so that the solids are in the air.
LIQUID = {"Liquid": {"Drop": {"Type": "box", "Lower": (-1., -1.), "Upper": (1., -.875)}}}


def scene(solids, step, end, gravity=0., contact="none", upper=1., cells=32, **more):
    return xml("Scene", {
        "Dimension": 2, "Domain": {"Lower": (-1., -1.), "Upper": (upper, 1.), "Cells": (cells, 32)},
        "Fluid": {"Density": 1000., "Gravity": (0., gravity), "Free Surface": LIQUID},
        "Solids": solids, "Contact": {"Type": contact, **more}, "Time": {"End": end, "Fixed Step": step}, "Output": {"Frames": False}})


def block(position, stiffness, **more):
    return {"Type": "deformable body", "Geometry": {"Shape": "box", "Size": (.3, .2), "Mesh Spacing": .06},
            "Material": {"Type": "neo-hookean", "Young's Modulus": stiffness, "Poisson's Ratio": .3}, "Density": 1000.,
            "Position": position, "Time Integration": "fully-implicit", **more}


def ball(density):
    return {"Type": "rigid body", "Geometry": {"Shape": "ball", "Radius": .2}, "Density": density, "Position": (.6, -.3),
            "Velocity": (0., 3.)}


class SolidsAlone(unittest.TestCase):
    def run_scene(self, text):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        file = Path(folder.name) / "scene.xml"
        file.write_text(text)
        output = Path(folder.name) / "output"
        simulate(file, output)
        return output

    def elastic_energies(self, *arguments, **more):
        return column(table(self.run_scene(scene(*arguments, **more)) / "history.csv"), "elastic_energy")

    def test_a_disc_rolls_down_a_slope(self):
        """With 2/3 of g sin(20 deg), 2.235 m/s^2; where the floor met it ahead of its centre it took 1.55."""
        disc = {"Type": "rigid body", "Geometry": {"Shape": "ball", "Radius": .1, "Mesh Spacing": .01}, "Density": 1000.,
                "Position": (.3, .1), "Friction": .3}
        for step in (.01, .005):
            text = xml("Scene", {
                "Dimension": 2, "Domain": {"Lower": (0., 0.), "Upper": (3., 1.), "Cells": (30, 10),
                                           "Sides": {"y lower": {"Type": "slip wall"}, "y upper": {"Type": "open"}}},
                "Fluid": {"Density": .001, "Gravity": (3.35522, -9.21838)}, "Solids": {"Disc": disc},
                "Coupling": {"Type": "mixed face"}, "Time": {"End": 1., "Fixed Step": step}, "Output": {"Frames": False}})
            end = table(self.run_scene(text) / "bodies.csv")[-1]
            self.assertAlmostEqual(float(end["vx"]), 2.235, delta=.02 * 2.235)
            self.assertAlmostEqual(-.1 * float(end["wz"]), float(end["vx"]), delta=.01)

    def test_a_soft_disc_rolls_on(self):
        """Ten radians at 0.05 rad a step: .87 of 1 m/s are left. Contact that foresees chords leaves .81, and .59 if it stops nodes
        before they touch."""
        disc = {"Type": "deformable body", "Geometry": {"Shape": "ball", "Radius": .1, "Mesh Spacing": .005}, "Density": 1000.,
                "Material": {"Type": "neo-hookean", "Young's Modulus": 1e6, "Poisson's Ratio": .3}, "Friction": .3,
                "Position": (.3, .101), "Velocity": (1., 0.), "Angular Velocity": -10.}
        text = xml("Scene", {
            "Dimension": 2, "Domain": {"Lower": (0., 0.), "Upper": (1.8, .3), "Cells": (72, 12),
                                       "Sides": {"y lower": {"Type": "slip wall"}, "y upper": {"Type": "open"}}},
            "Fluid": {"Density": .001, "Gravity": (0., -9.8)}, "Solids": {"Disc": disc},
            "Time": {"End": 1., "Fixed Step": .005}, "Output": {"Frames": False}})
        output = self.run_scene(text)
        rows, history = table(output / "bodies.csv"), table(output / "history.csv")
        self.assertGreater(column(rows, "vx")[-1], .84)
        self.assertAlmostEqual(-.1 * column(rows, "wz")[-1], column(rows, "vx")[-1], delta=.03)
        energies = [sum(parts) for parts in zip(*(column(history, name) for name in ("solid_kinetic_energy", "elastic_energy")))]
        self.assertLess(max(energies), energies[0] + 31 * 9.8 * .001)  # it lies down by less than a millimetre

    def test_stiff_blocks_that_turn_are_settled(self):
        # Turned by 0.4 in a step, whose chords stretch it to far more energy than it has.
        turns = block((-.5, 0.), 1e7, **{"Angular Velocity": 20.})
        alone = self.elastic_energies({"A": turns}, .02, .02)[-1]
        self.assertLess(alone, 100.)
        for solids in ({"A": turns, "B": ball(5e5)}, {"A": {**turns, "Velocity": (0., 3.)}}):
            energy = self.elastic_energies(solids, .02, .02, upper=1.5, cells=40)[-1]
            self.assertAlmostEqual(energy, alone, delta=.02 * alone)

    def test_blocks_that_swing_are_damped_as_they_would_be(self):
        swings = block((-.4, 0.), 1e6, **{"Vortices": {"Amplitude": .5, "Wavelength": .4}})
        alone = self.elastic_energies({"A": swings}, .01, .1)
        for solids in ({"A": swings, "B": ball(5e3)}, {"A": {**swings, "Velocity": (0., 3.)}}):
            for one, other in zip(alone, self.elastic_energies(solids, .01, .1)):
                self.assertAlmostEqual(other, one, delta=.02 * max(alone))

    def test_a_block_that_lies_exactly_on_a_box_lies_still(self):
        # The weight of 60 kg strains its 0.2 m by 1e-2 or less.
        floor = {"Type": "rigid body", "Geometry": {"Shape": "box", "Size": (1.6, .2)}, "Density": 1000.,
                 "Position": (0., -.6), "Motion": {"Type": "static"}, "Friction": .3}
        lies = {**block((0., -.4), 1e5), "Time Integration": "semi-implicit", "Friction": .3}
        energies = self.elastic_energies({"Floor": floor, "Block": lies}, .005, .5, gravity=-9.8, contact="gauss seidel")
        self.assertLess(max(energies), 10.)

    def test_a_box_does_not_hang_in_the_air_above_cloth(self):
        # At 20 m/s and steps of 0.05 s it would pass cloth and floor in one. Both stop it where it is; then it falls
        # 0.5 m, and lies on the cloth.
        floor = {"Type": "rigid body", "Geometry": {"Shape": "box", "Size": (1.8, .2)}, "Density": 1000.,
                 "Position": (0., -.3), "Motion": {"Type": "static"}}
        falls = {"Type": "rigid body", "Geometry": {"Shape": "box", "Size": (.3, .3)}, "Density": 5000.,
                 "Position": (0., .4), "Velocity": (0., -20.)}
        cloth = {"Type": "cloth", "Geometry": {"Shape": "sheet", "Size": (.6, 0.), "Normal": "y", "Mesh Spacing": .05},
                 "Young's Modulus": 1e5, "Thickness": .01, "Surface Density": 5., "Position": (0., -.17),
                 "Time Integration": "fully-implicit", "Friction": .3}
        output = self.run_scene(scene({"Floor": floor, "Box": falls, "Cloth": cloth}, .05, .7, gravity=-9.8, contact="gauss seidel"))
        rows = [row for row in table(output / "bodies.csv") if "Box" in row.values()]
        self.assertLess(max(map(abs, column(rows, "vy"))), 4.)
        self.assertLess(column(rows, "y")[-1], 0.)
        self.assertGreater(column(rows, "y")[-1], -.06)
        self.assertLess(max(column(table(output / "history.csv"), "momentum_error")), 1e-10)

    def test_a_ring_that_hits_a_sheet_in_its_middle_keeps_the_symmetry(self):
        # Nodes lie above nodes, so that each is counted to one of the two edges beside it. A hundredth of a metre a second
        # where that edge takes the lever of the gap, of 2.2 with which the ring leaves; without friction there is none.
        cloth = {"Type": "cloth", "Young's Modulus": 1e4, "Thickness": .01, "Surface Density": 5.,
                 "Time Integration": "semi-implicit", "Friction": 0.}
        sheet = {**cloth, "Geometry": {"Shape": "sheet", "Size": (.6, 0.), "Normal": "y", "Mesh Spacing": .05}}
        ring = {**cloth, "Geometry": {"Shape": "ball", "Radius": .15, "Mesh Spacing": .06}, "Position": (0., .2),
                "Velocity": (0., -3.)}
        output = self.run_scene(scene({"Sheet": sheet, "Ring": ring}, .004, .08, contact="gauss seidel", **{"Maximum Iterations": 20000, "Tolerance": 1e-11}))
        rows = table(output / "bodies.csv")
        self.assertGreater(max(abs(row) for row in column(rows[-2:], "vy")), 1.)
        self.assertLess(max(map(abs, column(rows, "vx"))), 1e-9)


if __name__ == "__main__":
    unittest.main()
