"""Mechanisms that are thrown about with steps that turn them much too far: what energy they gain, and what they keep."""
import copy
import json
import math
import tempfile
from pathlib import Path

import numpy as np

from joint_cases import BALL_CHAIN, CHAIN, CHAIN_JOINTS, SQUARE
from jointed_scene import joint, run, unseen_box, vacuum

PENDULUM = ({"A": unseen_box((.5, 0.), 1.5), "B": unseen_box((1.5, 0.), -1.)},
            {"SA": joint("hinge", ("space", "A"), (0., 0.)), "AB": joint("hinge", ("A", "B"), (1., 0.))})
MIXED = ({"A": unseen_box((-1., 0., 0.), (.5, .7, 1.)), "B": unseen_box((0., 0., 0.), (0., -.6, -1.)),
          "C": unseen_box((1., 0., 0.), (.3, .4, 1.5))},
         {"AB": joint("universal", ("A", "B"), (-.5, 0., 0.), **{"Axis": (0., 1., 0.), "Second Axis": (0., 0., 1.)}),
          "BC": joint("cylinder", ("B", "C"), (.5, 0., 0.), Axis=(0., 0., 1.))})
ALONE = ({"A": unseen_box((0., 0., 0.), (.5, .7, 1.))}, {})
MECHANISMS = {"a body alone": ALONE, "three links, hinges": (CHAIN, CHAIN_JOINTS), "two links on a nail": PENDULUM, "three links, balls": BALL_CHAIN,
              "universal and cylinder": MIXED, "square of hinges": SQUARE}
TURNS = (.1, .2, .5, 1., 2., 4.)  # rad a step
N_STEPS = 60


def limits_of(kind):
    if kind == "ball":
        return {"Limits": {"Upper": .3}}
    if kind == "hinge":
        return {"Limits": {"Lower": -.3, "Upper": .3}}
    return {"Limits": {"Lower": (-.3, -.3), "Upper": (.3, .3)}}


def limited(solids, joints):
    """Limits all joints of a loop but one, which it must leave free."""
    bounded = list(joints)[:-1] if len(joints) == len(solids) and "space" not in str(joints) else list(joints)
    return solids, {name: {**one, **limits_of(one["Type"])} if name in bounded else one for name, one in joints.items()}


def with_mass(mass):
    """Returns the change that gives the last body this mass."""
    def change(solids, joints):
        last = list(solids)[-1]
        return {**solids, last: {**solids[last], "Mass": mass}}, joints
    return change


def doubled(solids, joints):
    """Every joint twice: each second one says nothing new."""
    return solids, {**joints, **{f"{name} again": one for name, one in joints.items()}}


def seen(solids, joints):
    """By next to nothing: contact knows only what fluid sees."""
    return {name: {key: value for key, value in solid.items() if key != "Seen by Fluid"} for name, solid in solids.items()}, joints


CONDITIONS = {"free": lambda solids, joints: (solids, joints), "limits": limited, "contact": seen, "heavy": with_mass(1e6),
              "light": with_mass(1e-6), "each joint twice": doubled}


def scene_of(mechanism, condition, step, n_steps):
    solids, joints = CONDITIONS[condition](*copy.deepcopy(MECHANISMS[mechanism]))
    scene = vacuum(solids, joints, step, step * n_steps)
    if condition in ("limits", "contact"):
        scene["Contact"] = {"Type": "gauss seidel"}
    if condition == "contact":  # with the walls of a box about them
        dimension = scene["Dimension"]
        scene["Domain"] = {"Lower": (-2.2,) * dimension, "Upper": (2.2,) * dimension, "Cells": (16 if dimension == 2 else 12,) * dimension}
        scene["Fluid"], scene["Coupling"] = {"Density": 1e-3}, {"Type": "flux"}
        scene["Solver"] = {"Tolerance": 1e-6}  # where bodies drive so thin a fluid about less is round-off of their momenta
    return scene


def momentum_error(history):
    """The error of the ledger is relative to the largest momentum of the step, and that is nothing where links turn about
    their middle: of those the angular one counts alone."""
    names = ["angular_momentum_error"]
    if max(abs(row[f"solid_momentum_{axis}"]) for row in history for axis in "xy") > 1e-6:
        names.append("momentum_error")
    return max(row[name] for row in history for name in names)


def chain_of_cubes(step, n_steps):
    """Chain of cubes: the inertia of a cube does not depend on its orientation."""
    solids = {name: {**one, "Geometry": {"Shape": "box", "Size": (1., 1., 1.)}} for name, one in BALL_CHAIN[0].items()}
    return vacuum(solids, BALL_CHAIN[1], step, step * n_steps)


def driven_in(depth, step, n_steps):
    """Three links at rest, the last of which hangs and stands in the floor."""
    def link(place, turn):
        return {**{key: value for key, value in unseen_box(place, 0.).items() if key != "Seen by Fluid"}, "Rotation": turn}
    down = -math.pi / 3
    solids = {"A": link((-1 - .5 * math.cos(.4), .5 * math.sin(.4)), math.pi - .4), "B": link((-.5, 0.), 0.),
              "C": link((.5 * math.cos(down), .5 * math.sin(down)), down)}
    scene = vacuum(solids, {"AB": joint("hinge", ("A", "B"), (-1., 0.)), "BC": joint("hinge", ("B", "C"), (0., 0.))}, step, n_steps * step)
    floor = math.sin(down) - .1 * math.cos(down) + depth
    scene.update({"Contact": {"Type": "gauss seidel"}, "Fluid": {"Density": 1e-3}, "Coupling": {"Type": "flux"},
                  "Domain": {"Lower": (-2.4, floor), "Upper": (1.6, floor + 4.), "Cells": (16, 16)}})
    return scene


def moment(rows):
    """About the origin, of cubes of 1 m and 1 kg."""
    vectors = [[np.array([row[head + axis] for axis in "xyz"]) for head in ("", "v", "w")] for row in rows]
    return sum(np.cross(place, speed) + spin / 6 for place, speed, spin in vectors)


def flown(scene):
    """history.csv, bodies.csv by name, and how many steps gave impulses at their end alone."""
    with tempfile.TemporaryDirectory() as folder:
        history, bodies = run(scene, folder=folder)
        summary = json.loads((Path(folder) / "output/summary.json").read_text())
    return history, bodies, summary.get("joints", {}).get("steps_of_end_impulses", 0)


def thrown(mechanism, condition, turns=TURNS, n_steps=N_STEPS):
    """By turn: the most energy over that of the start, less 1; the part of it that is left; the worst of the momentum
    errors; the steps whose impulse acted at the end."""
    history, bodies = run(scene_of(mechanism, "free" if condition == "contact" else condition, 1e-7, 1))
    spin = max(abs(rows[0][axis]) for rows in bodies.values() for axis in ("wx", "wy", "wz") if axis in rows[0])
    start = history[0]["solid_kinetic_energy"]
    results = {}
    for turn in turns:
        history, _, at_end = flown(scene_of(mechanism, condition, turn / spin, n_steps))
        energy = [row["solid_kinetic_energy"] / start for row in history]
        results[turn] = {"gain": max(energy) - 1, "loss": 1 - min(energy), "left": energy[-1],
                         "momentum": momentum_error(history), "at_end": at_end}
    return results
