"""Nothing comes through a hull in space either: a boat and shells in a storm, with all that is in them watched.

LOCKSTEP_LONG_STORM=1: 1000 steps each, else 20.
"""
import math
import os
import unittest

from test_leaks import Storm, xml

N_STEPS = 1000 if os.environ.get("LOCKSTEP_LONG_STORM") else 20
H = 1.5 / 24  # spacing of the cells [m]
PLACE = (1.2, .55, .5)
INSIDE = {"Inside": {"Point": PLACE, "Solid": "Shell"}, "Outside": {"Point": (.5, .1, .5)}}
# Beside a ball whole cells come and go: those of half its area may be off.
CELLS_BESIDE = H * 3 / .25 / 2


def scene(solids, watch, dry=(), full=()):
    """A tank in which a paddle makes waves, askew so that no two cells are alike."""
    paddle = {"Type": "rigid body", "Geometry": {"Shape": "plate", "Size": (0., .9, .7), "Normal": "x"},
              "Position": (.2, .3, .45), "Motion": {"Type": "sinusoid", "Amplitude": (.12, 0., 0.), "Frequency": 1.1}}
    liquids = {"Pool": {"Type": "level", "Height": "0.6 + 0.12*cos(2*_pi*x)"}}
    if full:
        liquids["Fill"] = {"Type": "ball", "Center": full, "Radius": .25}
    surface = {"Liquid": liquids, "Watch": watch}
    if dry:
        surface["Dry Points"] = dry
    return xml("Scene", {
        "Dimension": 3, "Domain": {"Lower": (0., 0., 0.), "Upper": (2., 1.5, 1.), "Cells": (32, 24, 16)},
        "Fluid": {"Density": 1000., "Gravity": (0., -9.8, 0.), "Free Surface": surface},
        "Solids": {"Paddle": paddle, **solids},
        "Time": {"End": 100., "Fixed Step": .01}, "Output": {"Frame Interval": 1000.}})


def shell(amplitude):
    """Shoved and turned by a script."""
    return {"Type": "rigid body", "Geometry": {"Shape": "ball", "Radius": .25, "Thin Shell": True}, "Position": PLACE,
            "Motion": {"Type": "sinusoid", "Amplitude": amplitude, "Angular Amplitude": (.5, 1., .3), "Frequency": .9}}


def sheet(x):
    """From floor to lid and from side to side."""
    return {"Type": "rigid body", "Geometry": {"Shape": "plate", "Size": (0., 1.6, 1.1), "Normal": "x"},
            "Position": (x, .75, .5), "Motion": {"Type": "sinusoid", "Amplitude": (.1, 0., 0.), "Frequency": 1.}}


HULL = {"Type": "rigid body", "Geometry": {"Shape": "open box", "Size": (.5, .4, .4)}, "Surface Density": 25.,
        "Position": (1.2, .6, .47)}
SHOVE = (.2, .12, .06)


class LeaksInSpace(Storm):
    scenes = {
        "hull": scene({"Hull": HULL}, {"Inside": {"Point": (1.2, .5, .47), "Solid": "Hull", "Radius": .15},
                                       "Outside": {"Point": (.5, .1, .5)}}, dry=(1.2, .5, .47)),
        "empty shell": scene({"Shell": shell(SHOVE)}, INSIDE, dry=PLACE),
        "full shell": scene({"Shell": shell(SHOVE)}, INSIDE, full=PLACE),
        "sheets": scene({"Left": sheet(1.2), "Right": sheet(1.2 + H / 10)},
                        {"Left": {"Point": (.6, .2, .5)}, "Right": {"Point": (1.8, .2, .5)}}, dry=(1.8, .2, .5)),
    }

    def test_hull(self):
        rows = self.storm("hull", steps=N_STEPS)
        self.assertGreater(min(self.inside(rows, "Outside")), .5)

    def test_empty_shell_stays_empty(self):
        rows = self.storm("empty shell", ranks=2, steps=N_STEPS)
        self.assertEqual(max(self.inside(rows)), 0)
        self.assert_closed(rows, "Outside")

    def test_full_shell_keeps_what_is_in_it(self):
        rows = self.storm("full shell", steps=N_STEPS)
        volume = 4 / 3 * math.pi * .25**3
        for row in rows:
            self.assertAlmostEqual(float(row["watch_Inside_volume"]) / volume, 1, delta=CELLS_BESIDE)
        for watch in ("Inside", "Outside"):
            self.assert_closed(rows, watch)

    def test_two_sheets(self):
        rows = self.storm("sheets", steps=N_STEPS)
        self.assertEqual(max(self.inside(rows, "Right")), 0)
        self.assertGreater(min(self.inside(rows, "Left")), .3)


if __name__ == "__main__":
    unittest.main()
