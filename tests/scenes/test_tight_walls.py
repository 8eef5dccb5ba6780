"""Walls of closed solids let nothing through, however thin and at whatever angle, and carry the pressure on both sides, with both
couplings. Under flux each of these scenes leaked while a cell through which a wall goes had its fluid on both sides of it."""
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from scene_xml import xml  # noqa: E402
from simulation import column, simulate, table  # noqa: E402

COUPLINGS = ("flux", "mixed face")
OPEN = {"x lower": {"Type": "open"}, "x upper": {"Type": "open"}}


def wall(size, position):
    return {"Type": "rigid body", "Geometry": {"Shape": "box", "Size": size}, "Position": position,
            "Motion": {"Type": "static"}}


class TightWalls(unittest.TestCase):
    def run_scene(self, scene, files, *options):
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "scene.xml"
            file.write_text(xml("Scene", {"Output": {"Frames": False}, **scene}))
            simulate(file, Path(folder) / "run", *options)
            return [table(Path(folder) / "run" / f"{name}.csv") for name in files]

    def driven_flow(self, coupling, size, rotation, position):
        """The flow [m^2/s] through a channel that a body force drives and a wall closes; 0.2 without the wall."""
        dimension = len(size)
        across = (1.,) * (dimension - 1)
        line = {"Lower": (.5, *(0. for _ in across)), "Upper": (.5, *across)}
        flow, = self.run_scene({
            "Dimension": dimension,
            "Domain": {"Lower": (0.,) * dimension, "Upper": (2., *across), "Cells": (16, *(8 for _ in across)), "Sides": OPEN},
            "Fluid": {"Density": 1000., "Body Force": (1., *(0. for _ in across))},
            "Solids": {"Wall": {**wall(size, (position, *(.5 for _ in across))), "Rotation": rotation}},
            "Observers": {"Flow": {"Type": "flow", **line}}, "Coupling": {"Type": coupling},
            "Time": {"End": .2, "Fixed Step": .02}}, ["Flow"])
        return abs(column(flow, "volume_rate")[-1])

    def test_a_wall_across_a_channel_stops_the_flow(self):
        for coupling in COUPLINGS:
            for thickness in (.005, .0625, .12):
                for angle in (0., .35, .7854):
                    for position in (1.0625, 1.1):
                        with self.subTest(coupling=coupling, thickness=thickness, angle=angle, position=position):
                            self.assertLess(self.driven_flow(coupling, (thickness, 3.), angle, position), 1e-9)

    def test_a_wall_in_space_stops_the_flow(self):
        for thickness in (.0625, .12):
            with self.subTest(thickness=thickness):
                self.assertLess(self.driven_flow("flux", (thickness, 3., 3.), (0., .2, .3), 1.0625), 1e-9)

    def pressure_before_slot(self, coupling, thickness):
        """Returns the pressure [Pa] of a stream of .2 m/s through a slot of .2 m in a wall."""
        shape = {"Shape": "box", "Size": (thickness, .4)} if thickness else {"Shape": "plate", "Normal": "x", "Size": (0., .4)}
        plates = {name: {"Type": "rigid body", "Geometry": shape, "Position": (1.0104166666666667, y), "Motion": {"Type": "static"}}
                  for name, y in (("Below", .2), ("Above", .8))}
        points, slot = self.run_scene({
            "Dimension": 2,
            "Domain": {"Lower": (0., 0.), "Upper": (3., 1.), "Cells": (144, 48),
                       "Sides": {"x lower": {"Type": "inflow", "Velocity": (.2, 0.)}, "x upper": {"Type": "open"}}},
            "Fluid": {"Density": 1., "Viscosity": .005}, "Solids": plates,
            "Observers": {"Up": {"Type": "points", "Points": (.5, .5)},
                          "Slot": {"Type": "flow", "Lower": (1., .4), "Upper": (1., .6)}},
            "Coupling": {"Type": coupling}, "Time": {"End": 3., "Largest Step": .02}}, ["Up", "Slot"])
        return column(points, "pressure")[-1], column(slot, "volume_rate")[-1]

    def test_a_slot_resists_as_one_in_a_shell(self):
        """Without the rule a third of the flow went through the slot, and the pressure was a tenth."""
        expected, _ = self.pressure_before_slot("flux", 0)
        for thickness in (.002, .01):
            with self.subTest(thickness=thickness):
                pressure, flow = self.pressure_before_slot("flux", thickness)
                self.assertAlmostEqual(pressure / expected, 1, delta=.15)
                self.assertGreater(flow, .19)

    def test_a_wall_between_water_and_void_carries_the_water(self):
        """rho g H^2 / 2 = 784.8 N a metre, where the wall takes a cell or less."""
        for coupling in COUPLINGS:
            for thickness in (.03, .05):
                for left in (.01, .03):
                    with self.subTest(coupling=coupling, thickness=thickness, left=left):
                        bodies, = self.run_scene({
                            "Dimension": 2,
                            "Domain": {"Lower": (-.8, 0.), "Upper": (.4, .6), "Cells": (24, 12),
                                       "Sides": {"y upper": {"Type": "open"}}},
                            "Fluid": {"Density": 1000., "Gravity": (0., -9.81), "Viscosity": 2., "Free Surface": {"Liquid": {
                                "Box": {"Type": "box", "Lower": (-2., -1.), "Upper": (left, .4)}}}},
                            "Solids": {"Dam": wall((thickness, 1.2), (left + thickness / 2, .5))},
                            "Coupling": {"Type": coupling}, "Contact": {"Type": "none"},
                            "Time": {"End": .1, "Fixed Step": .01}}, ["bodies"])
                        self.assertAlmostEqual(column(bodies, "fx")[-1] / (.5 * 1000 * 9.81 * .4 ** 2), 1, delta=.02)


if __name__ == "__main__":
    unittest.main()
