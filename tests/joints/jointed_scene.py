"""Scenes of jointed bodies, and what comes of them."""
import json
import math
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
import simulation  # noqa: E402
from scene_xml import xml  # noqa: E402

LARGE = 100.  # a largest turn that bounds no step


def unseen_box(position, angular_velocity, mass=1.):
    """A box that no fluid sees: it moves as in vacuum."""
    size = (1., .2, .3)[:len(position)]
    return {"Type": "rigid body", "Geometry": {"Shape": "box", "Size": size}, "Mass": mass, "Seen by Fluid": False,
            "Position": position, "Angular Velocity": angular_velocity}


def joint(kind, solids, point, **more):
    return {"Type": kind, "Solids": solids, "Point": point, **more}


def in_order(scene, order):
    """The scene with steps of that order in time; they are of second order by default."""
    scene["Time"]["Order in Time"] = order
    return scene


def vacuum(solids, joints, step, end, impulses="two halves", turn=LARGE):
    dimension = len(next(iter(solids.values()))["Position"])
    return {"Dimension": dimension, "Domain": {"Cells": (4,) * dimension}, "Fluid": {"Density": 1.},
            "Contact": {"Type": "none"}, "Solids": solids, "Joints": joints,
            "Articulation": {"Impulses": impulses}, "Time": {"End": end, "Fixed Step": step, "Largest Turn": turn}, "Output": {"Frames": False}}


def tank(solids, joints, coupling, viscosity=0., step=.01, end=.1, **articulation):
    scene = {"Dimension": 2, "Domain": {"Cells": (24, 24)},
             "Fluid": {"Density": 1000., "Viscosity": viscosity, "Gravity": (0., -9.8)},
             "Contact": {"Type": "none"}, "Coupling": {"Type": coupling}, "Solids": solids,
             "Time": {"End": end, "Fixed Step": step}, "Output": {"Frames": False}, "Solver": {"Tolerance": 1e-11}}
    if joints:
        scene["Joints"] = joints
        scene["Time"]["Largest Turn"] = LARGE
        scene["Articulation"] = articulation
    return scene


def table(path):
    """The rows of a table as numbers, but for names; all of them finite, because `max` would miss one that is not."""
    rows = [{key: value if key == "name" else float(value) for key, value in row.items()}
            for row in simulation.table(path)]
    bad = {key for row in rows for key, value in row.items() if key != "name" and not math.isfinite(value)}
    assert not bad, f"{path.name}: not finite: {bad}"
    return rows


def run(scene, ranks=1, arguments=(), folder=None):
    """history.csv and, by name of the body, bodies.csv."""
    with tempfile.TemporaryDirectory() as own:
        file, output = Path(own) / "scene.xml", Path(folder or own) / "output"
        file.write_text(xml("Scene", scene))
        simulation.simulate(file, output, *arguments, ranks=ranks)
        bodies = {}
        for row in table(output / "bodies.csv"):
            bodies.setdefault(row["name"], []).append(row)
        return table(output / "history.csv"), bodies


def summary_of(scene, ranks=1, arguments=()):
    """summary.json."""
    with tempfile.TemporaryDirectory() as folder:
        run(scene, ranks, arguments, folder)
        return json.loads((Path(folder) / "output/summary.json").read_text())


def joints_of(scene, arguments=()):
    """joints.csv, by name."""
    with tempfile.TemporaryDirectory() as folder:
        run(scene, arguments=arguments, folder=folder)
        rows = {}
        for row in table(Path(folder) / "output" / "joints.csv"):
            rows.setdefault(row["name"], []).append(row)
        return rows
