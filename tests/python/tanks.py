"""Scenes in a tank, as dictionaries."""

DENSITY, GRAVITY = 1000., 9.8


def tank(dimension=2, solids=None, **more):
    """A tank of one metre, with a lid."""
    down = (0., -GRAVITY, 0.)[:dimension]
    return {"Dimension": dimension, "Domain": {"Cells": (16,) * dimension},
            "Fluid": {"Density": DENSITY, "Gravity": down}, "Solids": solids or {}, "Solver": {"Tolerance": 1e-12},
            "Time": {"End": .05, "Fixed Step": .01}, "Output": {"Frames": False}, **more}


def ball(dimension=2, density=500., **more):
    return {"Type": "rigid body", "Geometry": {"Shape": "ball", "Radius": .2}, "Density": density,
            "Position": (.5, .45, .5)[:dimension], **more}


def unseen_box(dimension=2):
    """A box of 2 kg, which no fluid sees: it moves as in vacuum. Its moment of inertia is 2 (1 + .04) / 12 about z."""
    return {"Type": "rigid body", "Geometry": {"Shape": "box", "Size": (1., .2, .2)[:dimension]}, "Mass": 2.,
            "Seen by Fluid": False, "Position": (.5, .5, .5)[:dimension]}
