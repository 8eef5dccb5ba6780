"""The scenes whose motion is known, which tests hold to bounds and tools/measure-joints to figures."""
import math

import free_chain
import numpy as np
from jointed_scene import joint, run, tank, unseen_box, vacuum

CHAIN = {name: unseen_box((float(k - 1), 0.), spin) for k, (name, spin) in enumerate(zip("ABC", free_chain.SPINS))}
CHAIN_JOINTS = {"AB": joint("hinge", ("A", "B"), (-.5, 0.)), "BC": joint("hinge", ("B", "C"), (.5, 0.))}
CHAIN_MOMENT = 2 / 12 * 1.3  # sum of m x vy + I w, the same before and after the joints act
AXIS = {"Axis": (0., 0., 1.)}


def chain(step, end=2., impulses="two halves", turn=100.):
    return vacuum(CHAIN, CHAIN_JOINTS, step, end, impulses, turn)


def hanging_chain(n_links, in_water):
    """.8 m of boxes on hinges in a tank of 32 x 32 cells, pulled aside by gravity that leans a little."""
    length = .8 / n_links
    solids = {f"L{k}": {"Type": "rigid body", "Geometry": {"Shape": "box", "Size": (.02, .9 * length)}, "Density": 3000.,
                        "Position": (.5, .9 - (k + .5) * length), "Seen by Fluid": in_water} for k in range(n_links)}
    joints = {f"J{k}": joint("hinge", (f"L{k - 1}" if k else "space", f"L{k}"), (.5, .9 - k * length)) for k in range(n_links)}
    return {"Dimension": 2, "Domain": {"Cells": (32, 32)}, "Fluid": {"Density": 1000., "Gravity": (1., -9.8)}, "Contact": {"Type": "none"},
            "Coupling": {"Type": "mixed face"}, "Solids": solids, "Joints": joints, "Time": {"Fixed Step": .002, "End": 1.},
            "Output": {"Frames": False}}


def energies(history):
    return np.array([row["solid_kinetic_energy"] for row in history])


def chain_changes(history):
    """Relative change of the energy since the start, by step."""
    return energies(history) / free_chain.energy(free_chain.start()[1]) - 1


def chain_moment(bodies):
    inertia = free_chain.MASSES[2, 2]
    last = [rows[-1] for rows in bodies.values()]
    return sum(row["x"] * row["vy"] - row["y"] * row["vx"] + inertia * row["wz"] for row in last)


def chain_error(bodies, time=2.):
    """Largest of the middles' distances along an axis from where the equations of motion have them."""
    exact, _ = free_chain.state(time)
    last = np.array([[bodies[name][-1][axis] for axis in "xy"] for name in "ABC"])
    return np.abs(last - exact.reshape(3, 3)[:, :2]).max()


def links_on_balls():
    spins = ((.5, .7, 1.), (0., -.6, -1.), (.3, .4, 1.5))
    solids = {name: unseen_box((k - 1., 0., 0.), spin) for k, (name, spin) in enumerate(zip("ABC", spins))}
    return solids, {"AB": joint("ball", ("A", "B"), (-.5, 0., 0.)), "BC": joint("ball", ("B", "C"), (.5, 0., 0.))}


def links_in_a_square():
    """Four of them, in space: 20 rows, of which 3 say nothing new."""
    spin = {"A": (.1, .2, .5), "B": (.1, .2, -1.2), "C": (0., 0., 0.), "D": (0., 0., 0.)}
    places = {"A": (.5, 0., 0.), "B": (1., .5, 0.), "C": (.5, 1., 0.), "D": (0., .5, 0.)}
    solids = {name: unseen_box(places[name], spin[name], mass) for name, mass in zip("ABCD", (1., 2., 1., 1.))}
    corners = {"AB": (1., 0., 0.), "BC": (1., 1., 0.), "CD": (0., 1., 0.), "DA": (0., 0., 0.)}
    return solids, {name: joint("hinge", tuple(name), corner, **AXIS) for name, corner in corners.items()}


BALL_CHAIN = links_on_balls()
SQUARE = links_in_a_square()


def ball_chain(step, end=5.):
    return vacuum(*BALL_CHAIN, step, end)


def square(step, end=5.):
    return vacuum(*SQUARE, step, end)


def square_end(bodies):
    return np.array([bodies[name][-1][axis] for name in "ABCD" for axis in ("x", "y", "z", "wx", "wy", "wz")])


BOX = {"Type": "rigid body", "Geometry": {"Shape": "box", "Size": (.4, .12)}, "Density": 300., "Rotation": 0.}
HALF = {**BOX, "Geometry": {"Shape": "box", "Size": (.2, .12)}, "Seen by Fluid": False}
WHOLE = {"Whole": {**BOX, "Position": (.5, .5), "Density": 300.000001}}
WELDS = {"left": joint("weld", ("Hull", "Left"), (.4, .5)), "right": joint("weld", ("Left", "Right"), (.5, .5))}


def parts(turn=0.):
    """A hull of no weight that the fluid sees, with what weighs as much as the whole in two parts inside."""
    along = np.array([math.cos(turn), math.sin(turn)]) * .1
    return {"Hull": {**BOX, "Density": 1e-6, "Position": (.5, .5), "Rotation": turn},
            "Left": {**HALF, "Position": tuple(np.array((.5, .5)) - along), "Rotation": turn},
            "Right": {**HALF, "Position": tuple(np.array((.5, .5)) + along), "Rotation": turn}}


def cut_in_two(turn=0., viscosity=0., end=.1):
    """A body, and its halves, both seen by the fluid, welded where they meet without a gap. Without the correction of
    buoyancy where it is aslant: half a body has no whole columns for that."""
    along = np.array([math.cos(turn), math.sin(turn)]) * .1
    half = {**HALF, "Seen by Fluid": True, "Rotation": turn}
    halves = {"Left": {**half, "Position": tuple(np.array((.5, .5)) - along)},
              "Right": {**half, "Position": tuple(np.array((.5, .5)) + along)}}
    scenes = [tank({"Whole": {**BOX, "Position": (.5, .5), "Rotation": turn}}, {}, "flux", viscosity, end=end),
              tank(halves, {"weld": WELDS["right"]}, "flux", viscosity, end=end)]
    for scene in scenes:
        scene["Coupling"]["Correct Buoyancy"] = turn == 0
    return scenes


def difference_of_halves(halves, whole):
    """Largest of the differences of place, velocity and spin."""
    left, right, expected = (bodies[-1] for bodies in (halves["Left"], halves["Right"], whole["Whole"]))
    middle = [abs((left[axis] + right[axis]) / 2 - expected[axis]) for axis in ("x", "y", "vx", "vy")]
    return max([*middle, abs(left["wz"] - expected["wz"])])


def pivoted(coupling, impulses=None):
    """A step of a heavy ball that hangs aslant, on a hinge to space; without `impulses` by its own pivot."""
    arm = np.array([math.sin(.6), -math.cos(.6)]) * .25
    ball = {"Type": "rigid body", "Geometry": {"Shape": "ball", "Radius": .1}, "Density": 2500.,
            "Position": tuple(np.array((.5, .75)) + arm)}
    if not impulses:
        return tank({"Ball": {**ball, "Pivot": tuple(-arm), "Locked": ("x", "y")}}, {}, coupling, end=.01)
    return tank({"Ball": ball}, {"H": joint("hinge", ("space", "Ball"), (.5, .75))}, coupling, end=.01, Impulses=impulses)


PISTON = {"stiffness": 2e5, "way": .05, "step": .01}


def piston(impulses, force=0., **control):
    """A step of a piston across a duct that is open at both ends."""
    body = {"Type": "rigid body", "Geometry": {"Shape": "box", "Size": (.25, 1.2)}, "Mass": 400., "Position": (.51, .5),
            "Force": (force, 0.)}
    slider = joint("slider", ("space", "Piston"), (.5, .5), Axis=(1., 0.), **control)
    scene = tank({"Piston": body}, {"S": slider}, "flux", step=PISTON["step"], end=PISTON["step"], Impulses=impulses)
    scene["Fluid"]["Gravity"] = (0., 0.)
    scene["Domain"]["Sides"] = {side: {"Type": "open"} for side in ("x lower", "x upper")}
    return scene


def sprung_piston(impulses):
    """(mass with its water, way and speed after a step on a spring, way and speed by the scheme's matrix). What mass the
    water adds is told by a force on the free piston."""
    stiffness, step = PISTON["stiffness"], PISTON["step"]
    force = stiffness * PISTON["way"]
    spring = {"Control": "proportional derivative", "Stiffness": stiffness, "Target": {"Type": "constant", "Value": PISTON["way"]}}
    by_force, by_spring = (run(scene)[1]["Piston"][-1] for scene in (piston(impulses, force), piston(impulses, **spring)))
    mass = step ** 2 / 2 * force / (by_force["x"] - .51)
    return mass, (by_spring["x"] - .51, by_spring["vx"]), (step ** 2 / 2 * force / (mass + step ** 2 / 4 * stiffness),
                                                         step * force / (mass + step ** 2 / 2 * stiffness))


ARM_INERTIA = (1 + .2 ** 2) / 12 + .5 ** 2  # about the hinge


def motor_arm(step, end, load=0., **control):
    """An arm on a hinge to space, in vacuum."""
    solids = {"A": {**unseen_box((0., 0.), 0.), "Torque": load}}
    return vacuum(solids, {"H": joint("hinge", ("space", "A"), (-.5, 0.), **control)}, step, end)


def sprung_arm(step, ratio=1., **more):
    return motor_arm(step, 2., Control="proportional derivative", Target={"Type": "constant", "Value": 1.},
                     **{"Natural Frequency": 1., "Damping Ratio": ratio, **more})


SWIMMER_LENGTH = .4


def swimmer(viscosity, end, n_cells=32):
    """Two links that a hinge bends to and fro, each second."""
    def link(length, x):
        return {"Type": "rigid body", "Geometry": {"Shape": "box", "Size": (length, .06)}, "Density": 1000.,
                "Position": (x, .5)}
    stroke = {"Type": "sinusoid", "Amplitude": .8, "Frequency": 1.}
    hinge = {"H": joint("hinge", ("Long", "Short"), (.5, .5), Control="prescribed", Target=stroke)}
    scene = tank({"Long": link(.25, .36), "Short": link(.15, .59)}, hinge, "flux", viscosity, .01, end)
    scene["Fluid"]["Gravity"] = (0., 0.)
    scene["Domain"]["Cells"] = (n_cells, n_cells)
    scene["Solver"] = {"Tolerance": 1e-9}
    return scene


def swum(bodies):
    """In the last of three periods, over its length."""
    places = np.array([(row["x"], row["y"]) for row in bodies["Long"]])
    return np.linalg.norm(places[299] - places[199]) / SWIMMER_LENGTH
