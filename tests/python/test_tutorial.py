"""The scene of docs/tutorials/steer-from-python.md, which quotes it."""
import os
import tempfile
from pathlib import Path

import lockstep

os.chdir(tempfile.mkdtemp())
scene = {
    "Dimension": 2,
    "Domain": {"Cells": (16, 16)},
    "Fluid": {"Density": 1000, "Gravity": (0, -9.81)},
    "Solids": {"Ball": {"Type": "rigid body", "Geometry": {"Shape": "ball", "Radius": .2}, "Density": 500, "Position": (.5, .4)}},
    "Time": {"End": .1, "Fixed Step": .01},
}
with lockstep.Run(scene, "run") as run:
    run.observe("height", lambda run: run.bodies()["Ball"]["position"][1], [("y", "m")])
    while run.step():
        pass
    assert run.bodies()["Ball"]["position"][1] > .4, "it rises"
assert len(Path("run/height.csv").read_text().splitlines()) >= 12
