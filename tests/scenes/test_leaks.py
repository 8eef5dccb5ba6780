"""Nothing comes through a hull: hulls and shells in a storm, in two dimensions, with all that is in them watched.

LOCKSTEP_LONG_STORM=1: 1000 steps each, else 60.
"""
import os
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from scene_xml import xml  # noqa: E402
from simulation import column, simulate, table, without_times  # noqa: E402

N_STEPS = 1000 if os.environ.get("LOCKSTEP_LONG_STORM") else 60
H = 1.5 / 36  # spacing of the cells [m]
# Beside the shell, whole cells come and go: those of half its length may be off.
CELLS_BESIDE = H * 3.14 * .25 / (3.14 * .25**2)
PADDLE = {"Type": "rigid body", "Geometry": {"Shape": "plate", "Size": (0., .9), "Normal": "x"},
          "Position": (.2, .3), "Motion": {"Type": "sinusoid", "Amplitude": (.12, 0.), "Frequency": 1.1}}


def scene(solids, watch, dry=(), full=()):
    """A tank in which a paddle makes waves."""
    liquids = {"Pool": {"Type": "level", "Height": "0.6 + 0.12*cos(2*_pi*x)"}}
    if full:
        liquids["Fill"] = {"Type": "ball", "Center": full, "Radius": .25}
    surface = {"Liquid": liquids, "Watch": watch}
    if dry:
        surface["Dry Points"] = dry
    return xml("Scene", {
        "Dimension": 2, "Domain": {"Lower": (0., 0.), "Upper": (2., 1.5), "Cells": (48, 36)},
        "Fluid": {"Density": 1000., "Gravity": (0., -9.8), "Free Surface": surface},
        "Solids": {"Paddle": PADDLE, **solids},
        "Time": {"End": 100., "Fixed Step": .01}, "Output": {"Frame Interval": 1000.}})


def rigid_ring(**more):
    return {"Type": "rigid body", "Geometry": {"Shape": "ball", "Radius": .25}, "Position": (1.2, .5), **more}


def shell(**motion):
    ring = rigid_ring(**motion)
    ring["Geometry"] = {**ring["Geometry"], "Thin Shell": True}
    return ring


def soft_ring(stiffness):
    """Light, and so soft that waves bend it."""
    return {"Type": "cloth", "Geometry": {"Shape": "ball", "Radius": .25}, "Position": (1.2, .55),
            "Young's Modulus": stiffness, "Thickness": .01, "Surface Density": 5., "Stiffness Damping": .01,
            "Time Integration": "fully-implicit"}


def hull(density, position=(1.2, .6)):
    return {"Type": "rigid body", "Geometry": {"Shape": "open box", "Size": (.5, .4)}, "Surface Density": density,
            "Position": position}


SHOVED = {"Motion": {"Type": "sinusoid", "Amplitude": (.25, .15), "Angular Amplitude": 2., "Frequency": .9}}
OUTSIDE = {"Point": (.5, .1)}


def sheet(x):
    """From floor to lid, fixed."""
    return {"Type": "rigid body", "Geometry": {"Shape": "plate", "Size": (0., 1.6), "Normal": "x"},
            "Position": (x, .75), "Motion": {"Type": "sinusoid", "Amplitude": (.1, 0.), "Frequency": 1.}}


SCENES = {
    "hull": scene({"Hull": hull(25.)}, {"Inside": {"Point": (1.2, .5), "Solid": "Hull", "Radius": .2},
                                        "Outside": OUTSIDE}, dry=(1.2, .5)),
    "rim": scene({"Hull": hull(400., (1.2, .56))}, {"Inside": {"Point": (1.2, .46), "Solid": "Hull", "Radius": .15}},
                 dry=(1.2, .46)),
    "empty shell": scene({"Shell": shell(**SHOVED)}, {"Inside": {"Point": (1.2, .5), "Solid": "Shell"},
                                                      "Outside": OUTSIDE}, dry=(1.2, .5)),
    "full shell": scene({"Shell": shell(**SHOVED)}, {"Inside": {"Point": (1.2, .5), "Solid": "Shell"},
                                                     "Outside": OUTSIDE}, full=(1.2, .5)),
    "half full shell": scene({"Shell": shell(**SHOVED)}, {"Inside": {"Point": (1.2, .5), "Solid": "Shell"},
                                                          "Outside": OUTSIDE}),
    "empty ring": scene({"Ring": soft_ring(2e8)}, {"Inside": {"Point": (1.2, .55), "Solid": "Ring"},
                                                   "Outside": OUTSIDE}, dry=(1.2, .55)),
    "full ring": scene({"Ring": soft_ring(2e6)}, {"Inside": {"Point": (1.2, .55), "Solid": "Ring"},
                                                  "Outside": OUTSIDE}, full=(1.2, .55)),
    "sheets": scene({"Left": sheet(1.2), "Right": sheet(1.2 + H / 10)},
                    {"Left": {"Point": (.6, .2)}, "Right": {"Point": (1.8, .2)}}, dry=(1.8, .2)),
    # In the place of the paddle; it comes so near to the side that no centre of a cell is left between them.
    "slot": scene({"Paddle": {**sheet(.1), "Motion": {"Type": "sinusoid", "Amplitude": (-.09, 0.), "Frequency": 2.5}}},
                  {"Slot": {"Point": (.003, .5)}, "Outside": OUTSIDE}, dry=(.003, .5)),
}


class Storm(unittest.TestCase):
    """Runs `scenes`, by name."""
    scenes = {}

    def run_scene(self, text, ranks, steps):
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "scene.xml"
            file.write_text(text)
            simulate(file, folder + "/out", "--steps", steps, ranks=ranks, seconds=1500, audited=True)
            return table(Path(folder) / "out" / "history.csv")

    def storm(self, name, ranks=1, steps=N_STEPS):
        rows = self.run_scene(self.scenes[name], ranks, steps)
        self.assertEqual(len(rows), steps)
        return rows

    def inside(self, rows, watch="Inside"):
        return column(rows, f"watch_{watch}_volume")

    def assert_closed(self, rows, watch):
        """A place without a way out should hold always the same."""
        targets = column(rows, f"watch_{watch}_volume_target")
        self.assertLess(max(targets) / min(targets) - 1, 1e-9)


class Leaks(Storm):
    scenes = SCENES

    def test_a_restart_goes_on_the_same(self):
        with tempfile.TemporaryDirectory() as folder:
            file, whole, parts = (Path(folder) / name for name in ("scene.xml", "whole", "parts"))
            file.write_text(SCENES["hull"])
            for output, steps, more in ((whole, 30, ()), (parts, 15, ()),
                                        (parts, 30, ("--restart", parts / "checkpoint-000015.h5"))):
                simulate(file, output, "--steps", steps, *more)
            one, other = (without_times(table(output / "history.csv")) for output in (whole, parts))
            self.assertEqual(one, other)

    def test_hull(self):
        rows = self.storm("hull")
        self.assertGreater(min(self.inside(rows, "Outside")), .5)

    def test_rim_under_water_floods(self):
        inside = self.inside(self.storm("rim", steps=120))
        self.assertEqual(inside[0], 0)
        self.assertGreater(inside[-1], .02)

    def test_empty_shell_stays_empty(self):
        for ranks in (1, 2):
            rows = self.storm("empty shell", ranks)
            self.assertEqual(max(self.inside(rows)), 0)
            self.assert_closed(rows, "Outside")

    def keeps_its_water(self, name, error):
        """`error`: of the volume; the target is exact."""
        rows = self.storm(name)
        for watch in ("Inside", "Outside"):
            self.assert_closed(rows, watch)
        for row in rows:
            self.assertAlmostEqual(float(row["watch_Inside_volume"]) / float(row["watch_Inside_volume_target"]), 1, delta=error)

    def test_full_shell_keeps_what_is_in_it(self):
        self.keeps_its_water("full shell", CELLS_BESIDE)

    def test_half_full_shell_keeps_what_is_in_it(self):
        self.keeps_its_water("half full shell", CELLS_BESIDE)

    def test_empty_ring_stays_empty(self):
        rows = self.storm("empty ring")
        self.assertEqual(max(self.inside(rows)), 0)
        self.assert_closed(rows, "Outside")

    def test_full_ring_keeps_what_is_in_it(self):
        self.keeps_its_water("full ring", CELLS_BESIDE)

    def test_two_sheets(self):
        rows = self.storm("sheets")
        self.assertEqual(max(self.inside(rows, "Right")), 0)
        self.assertGreater(min(self.inside(rows, "Left")), .3)

    def test_a_place_without_cells_is_nan_until_it_has_some(self):
        rows = self.run_scene(self.scenes["slot"], 1, 16)
        for end in ("volume", "volume_target"):
            unknown = [row["step"] for row in rows if row[f"watch_Slot_{end}"] == "nan"]
            self.assertEqual(unknown, [str(step) for step in range(7, 14)])  # .09 sin(5 pi time) > .1 - H / 2
        self.assertEqual(self.inside(rows[-1:], "Slot"), [0])


if __name__ == "__main__":
    unittest.main()
