"""A fish that turns: to the wave of its bends comes a bend to one side.

turning_fish.py SCENE OUTPUT BEND END: the scene xml-params/scenes/fish-2d.xml, radians a joint, seconds
"""
import sys
from math import atan2, cos, pi, sin

import lockstep

JOINTS = ("Head to Neck", "Neck to Trunk", "Trunk to Loin", "Loin to Tail")


def swim(scene, output, bend, end):
    """Where the fish points [rad], after every step."""
    headings = []
    with lockstep.Run(scene, output, {"Time/End": end, "Time/Fixed Step": .02, "Domain/Cells": (64, 32)}) as run:
        while run.step():
            ramp = min(1., run.time)
            for number, joint in enumerate(JOINTS):
                phase = 2 * pi * (run.time - .1875 * number)
                run.set_target(joint, ramp * (.35 * sin(phase) + bend), ramp * .7 * pi * cos(phase))
            bodies = run.bodies()
            x, y = bodies["Head"]["position"] - bodies["Tail"]["position"]
            headings.append(atan2(y, x))
    return headings


if __name__ == "__main__":
    if len(sys.argv) != 5:
        sys.exit(__doc__)
    print(swim(sys.argv[1], sys.argv[2], float(sys.argv[3]), float(sys.argv[4]))[-1])
