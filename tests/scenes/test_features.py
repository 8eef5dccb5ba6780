"""A feature costs only the scenes that have it: no solve, stage, field, column or file of it is in any other.

Each scene is compared with the same scene and one feature more. What a run keeps and does is read from its output: the fields of a
frame and of a checkpoint, which holds all that lives from step to step; the columns of history.csv; the stages in summary.json.
"""
import json
import sys
import tempfile
import unittest
from pathlib import Path

import h5py

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/support"))
from scene_xml import xml  # noqa: E402
from simulation import column, simulate, table  # noqa: E402

STEPS = 3
SOLVES = " / iterations"
SOLVED_BY = ("s1", "f2", "s2", "viscous", "solid")  # looked at from the second step on: nobody projected the velocity of the start


def disc(x):
    return {"Type": "rigid body", "Geometry": {"Shape": "ball", "Radius": .12}, "Density": 1500., "Position": (x, .5)}


def soft_disc():
    return {**disc(.3), "Type": "deformable body", "Geometry": {"Shape": "ball", "Radius": .12, "Mesh Spacing": .05},
            "Material": {"Young's Modulus": 1e4}}


def with_all(scene, more):
    """The scene with the lists and values of `more` in it."""
    result = dict(scene)
    for name, value in more.items():
        result[name] = with_all(scene.get(name, {}), value) if isinstance(value, dict) else value
    return result


TANK = {"Dimension": 2, "Domain": {"Lower": (0., 0.), "Upper": (1., 1.), "Cells": (16, 16)},
        "Fluid": {"Density": 1000., "Gravity": (0., -9.8), "Velocity": ("sin(2*_pi*x)*cos(2*_pi*y)", "-cos(2*_pi*x)*sin(2*_pi*y)"), "Order in Time": 1},
        "Contact": {"Type": "none"}, "Time": {"End": 1., "Fixed Step": .01, "Order in Time": 1}}  # solids keep their step where joints are added
SURFACE = {"Fluid": {"Free Surface": {"Interface": {"Type": "level set"}, "Liquid": {"Water": {"Type": "level", "Height": .53}}}}}
DISCS = with_all(TANK, {"Solids": {"A": disc(.3), "B": disc(.7)}})
WATER = with_all(TANK, SURFACE)
HINGE = {"Joints": {"Hinge": {"Type": "hinge", "Solids": ("A", "B"), "Point": (.5, .5)}}}


def surface(more):
    return {"Fluid": {"Free Surface": more}}


def names(kind, *texts):
    return {f"{kind} {text}" for text in texts}


def solves(stage, first, last):
    """Coupled or Poisson solves of a stage in all steps, numbered from `first` to `last`."""
    return {f"solve {number} of {stage}" for number in range(first, last + 1)}


def fields(text):
    """Fields that a checkpoint holds for the next step."""
    return names("kept", *(f"fluid/{name}" for name in text.split()))


BARE = (names("stage", "F2", "F3 advection", "F3 advection / geometry", "F3 forces", "F3 forces / forces", "S2", "S2 / preconditioner",
              "S2 / right-hand side", "end", "solid motion") | solves("S2", 1, STEPS) | {"iterations of s2"}
        | names("frame", "fluid/fluid", "fluid/pressure", "fluid/velocity") | fields("velocity scaled_pressure cells_with_pressure")
        | {"file bodies.csv", "file history.csv"})
COUPLED = (names("stage", "F1", "F1 / forces", "S1", "S1 / preconditioner", "S1 / right-hand side") | solves("S1", 1, STEPS)
           | {"iterations of s1", "iterations of f2"})  # solids move the fluid's boundary, so that u^n is no u_ADV
FIRST_PRESSURE = names("stage", "F3 forces / viscosity", "F3 forces / preconditioner", "F3 forces / right-hand side") | {"iterations of viscous"}
ELEMENTS = "vertices simplices stress strain von_Mises_stress energy_density"

# Name, the scene without it, what the scene has more, what its run has more.
FEATURES = [
    ("smoke", TANK, {"Fluid": {"Smoke": {"Ambient": 0.}}}, {"frame fluid/smoke"} | fields("smoke")),
    ("temperature", TANK, {"Fluid": {"Temperature": {"Ambient": 0.}}}, {"frame fluid/temperature"} | fields("temperature")),
    # The pressure of the first two steps is found before their viscous solves.
    ("viscosity", TANK, {"Fluid": {"Viscosity": 1.}}, FIRST_PRESSURE | solves("F3 forces", 1, 2)),
    ("second order in time", TANK, {"Fluid": {"Order in Time": 2}}, fields("acceleration rate free")),
    ("the default order in time", TANK, {"Fluid": {"Order in Time": 0}}, fields("acceleration rate free")),
    ("moving tiles", TANK, {"Fluid": {"Moving Tiles": {}}}, fields("tiles")),
    ("energy budget", TANK, {"Observers": {"Budget": {"Type": "energy"}}},
     {"stage observers", "file Budget.csv", "kept observers/energy Budget/energy"}),
    ("rigid bodies", TANK, {"Solids": DISCS["Solids"]},
     COUPLED | names("kept", "rigid bodies/names", "rigid bodies/values")
     | names("frame", *(f"solids/{name}/{part}" for name in "AB" for part in ("vertices", "simplices", "velocity")))),
    ("a soft body", TANK, {"Solids": {"Soft": soft_disc()}},
     COUPLED | names("kept", *(f"deformable body/{part}" for part in ("names", "positions", "velocities", "surface velocities")))
     | names("frame", *(f"solids/Soft/{part}" for part in ("vertices", "simplices", "velocity")),
             *(f"solids/Soft_elements/{part}" for part in ELEMENTS.split()))),
    ("contact", DISCS, {"Contact": {"Type": "gauss seidel"}}, names("stage", "S1 / contact", "S2 / contact")),
    # Closing a joint takes a second solve for the positions.
    ("a joint", DISCS, HINGE, names("kept", "joints/names", "joints/values") | {"file joints.csv"} | solves("S1", STEPS + 1, 2 * STEPS)),
    ("a free surface", TANK, SURFACE,
     names("column", "liquid_bodies", "liquid_volume_target", "lost_volume", "volume_shift")
     | names("frame", "fluid/phi", "solids/water/vertices", "solids/water/simplices")
     | fields("interface_distance surface_filter_shift liquid_ledger")),
    ("particles at the surface", WATER, surface({"Interface": {"Type": "particle level set"}}),
     fields("interface_particles interface_particle_counts")),
    ("volume of fluid", WATER, surface({"Interface": {"Type": "volume of fluid"}}), fields("liquid_part liquid_defect")),
    ("trapped air", WATER, surface({"Trapped Air": "ideal gas"}),
     names("column", "gas_bubbles", "gas_volume", "gas_pressure") | fields("gas_bubble gas_amount gas_pressure")),
    ("explicit surface tension", WATER, surface({"Surface Tension": .07, "Time Integration": "explicit"}), set()),
    ("semi-implicit surface tension", WATER, surface({"Surface Tension": .07}),
     FIRST_PRESSURE | solves("F3 forces", 1, STEPS)),
    ("a watched place", WATER, surface({"Watch": {"Floor": {"Point": (.5, .1)}}}),
     names("column", "watch_Floor_volume", "watch_Floor_volume_target") | fields("watched_places")),
]


def stored(path):
    """Names of the datasets of a file, of those that ranks share (values and ids of cells) the name of both."""
    found = set()
    with h5py.File(path) as file:
        file.visititems(lambda name, item: found.add(name) if isinstance(item, h5py.Dataset) else None)
    return {name.rpartition("/")[0] if f"{name.rpartition('/')[0]}/ids" in found else name for name in found}


def stages(summary):
    for stage in summary["stages"]:
        name = stage["name"].removeprefix("step / ")
        if name.endswith(SOLVES):
            yield from solves(name.removesuffix(SOLVES), 1, stage["calls"])
        elif name not in ("start", "step", "frames", "checkpoints"):
            yield f"stage {name}"


def footprint(scene):
    """Solves, stages, fields, columns and files of a run of the scene."""
    with tempfile.TemporaryDirectory() as folder:
        file, run = Path(folder) / "scene.xml", Path(folder) / "run"
        file.write_text(xml("Scene", scene))
        simulate(file, run, "--steps", STEPS)
        rows = table(run / "history.csv")
        found = names("column", *rows[0]) | names("file", *(path.name for path in run.glob("*.csv")))
        found |= {f"iterations of {solve}" for solve in SOLVED_BY if any(column(rows[1:], f"{solve}_iterations"))}
        found |= names("frame", *stored(max((run / "frames").glob("*.h5")))) - {"frame xdmf"}
        found |= names("kept", *stored(run / f"checkpoint-{STEPS:06}.h5")) - {"kept files", "kept parameters"}
        return found | set(stages(json.loads((run / "summary.json").read_text())))


class Features(unittest.TestCase):
    maxDiff = None

    def test_a_tank_of_fluid_has_none(self):
        found = footprint(TANK)
        self.assertEqual({one for one in found if not one.startswith("column")}, BARE)
        optional = set().union(*(more for *_, more in FEATURES))
        self.assertEqual(found & optional, set())

    def test_each_adds_what_is_its_own(self):
        without = {}
        for name, scene, more, expected in FEATURES:
            with self.subTest(name):
                key = xml("Scene", scene)
                if key not in without:
                    without[key] = footprint(scene)
                found = footprint(with_all(scene, more))
                self.assertEqual(found - without[key], expected)
                self.assertEqual(without[key] - found, set(), "the scene without it has more")


if __name__ == "__main__":
    unittest.main()
