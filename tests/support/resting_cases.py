"""Solids at rest in contact in water, which a step must leave as they are: a raft with a load, stacks, an arch, a body under a roof, a cork
between shelves, a block on a slope just below the limit of friction and just beyond it. For tests/scenes and tools/measure-rest."""
import math
import pathlib
import tempfile

from scene_xml import xml
from simulation import attempt, column, table

G = 9.8
FRICTION = .5
HEAVY, LIGHT = (1.01, 2., 10., 1e3), (1e-3, .01, .1, .9)  # densities over that of water


class Tank:
    """A unit tank, up is the last axis. Sizes and places are (along, up); in space bodies are .4 m wide at most, in its middle."""

    def __init__(self, dimension, folder):
        self.dimension, self.folder = dimension, folder
        self.bodies = {}
        self.level, self.gravity = .8, (0.,) * (dimension - 1) + (-G,)

    def place(self, along, up):
        return (along, up) if self.dimension == 2 else (along, .5, up)

    def put(self, name, geometry, along, up, ratio=None, **more):
        """`ratio`: its density over that of water; None: held."""
        more.setdefault("Position", self.place(along, up))
        weight = {"Motion": {"Type": "static"}} if ratio is None else {"Density": 1000. * ratio}
        self.bodies[name] = {"Type": "rigid body", "Geometry": geometry, "Friction": FRICTION, **weight, **more}

    def box(self, name, size, along, up, ratio=None, **more):
        width, height = size
        self.put(name, {"Shape": "box", "Size": size if self.dimension == 2 else (width, min(width, .4), height)}, along, up, ratio, **more)

    def scene(self, step, coupling=None, interface=None):
        """`coupling` and `interface`: None for the defaults."""
        fluid = {"Density": 1000., "Gravity": self.gravity}
        if self.level:
            fluid["Free Surface"] = {"Liquid": {"Pool": {"Type": "level", "Height": self.level}}}
            if interface:
                fluid["Free Surface"]["Interface"] = {"Type": interface}
        n = 32 if self.dimension == 2 else 16
        return xml("Scene", {
            "Dimension": self.dimension, "Fluid": fluid, "Solids": self.bodies,
            "Domain": {"Upper": (1.,) * self.dimension, "Cells": (n,) * self.dimension},
            **({"Coupling": {"Type": coupling}} if coupling else {}),
            "Time": {"End": 1000., "Fixed Step": step}, "Output": {"Frames": False}})


def raft(tank, ratio):
    """It floats .065 m deep, of which its load bears the rest."""
    width, height, draft, edge = .6, .1, .065, .15
    across = 1 if tank.dimension == 2 else .4
    of_load = 1 if tank.dimension == 2 else edge
    tank.box("Raft", (width, height), .5, tank.level - draft + height / 2, ratio)
    load = (draft - ratio * height) * width * across / (edge**2 * of_load)
    tank.box("Load", (edge, edge), .5, tank.level - draft + height + edge / 2, load)


def stack(tank, ratio):
    for i in range(10):
        tank.box(f"Box {i}", (.2, .06), .5, .03 + .06 * i, ratio)


def stack_of_unequals(tank, ratio):
    """Light bodies below heavy ones."""
    for i in range(6):
        tank.box(f"Box {i}", (.2, .08), .5, .04 + .08 * i, ratio if i % 2 == 0 else 3. - ratio)


def arch(tank, ratio):
    """Five wedges between two abutments, a circle of .25 to .35 m inside and outside; plane."""
    inner, outer, foot, n = .25, .35, .1, 5
    for i in range(n):
        ends = [math.pi * (1 - k / n) for k in (i, i + 1)]
        corners = [(r * math.cos(a), r * math.sin(a)) for r, a in ((inner, ends[1]), (outer, ends[1]), (outer, ends[0]), (inner, ends[0]))]
        file = tank.folder / f"wedge-{i}.obj"
        file.write_text("".join(f"v {x!r} {y!r} 0\n" for x, y in corners) + "l 1 2\nl 2 3\nl 3 4\nl 4 1\n")
        tank.put(f"Wedge {i}", {"Shape": "file", "File": str(file), "Orient": True}, .5, foot, ratio)
    for name, side in (("Left", -1), ("Right", 1)):
        tank.box(name, (.14, foot), .5 + side * (inner + outer) / 2, foot / 2)


def roof(tank, ratio):
    tank.box("Roof", (.6, .1), .5, .6)
    tank.box("Body", (.2, .12), .47, .49, ratio)


def cork(tank, ratio):
    tank.box("Low", (.6, .1), .5, .2)
    tank.box("High", (.6, .1), .5, .5)
    tank.box("Cork", (.2, .2), .5, .35, ratio)


def slope(tank, ratio, part):
    """A full tank on a slope of `part` of the limit of friction: what is heavy lies on its floor, what is light under its lid."""
    angle = math.atan(FRICTION * part)
    tank.level = None
    tank.gravity = (G * math.sin(angle),) + (0.,) * (tank.dimension - 2) + (-G * math.cos(angle),)
    tank.box("Block", (.2, .1), .5, .05 if ratio > 1 else .95, ratio)


def holding(tank, ratio):
    slope(tank, ratio, .99)


def sliding(tank, ratio):
    slope(tank, ratio, 1.01)


RESTING = {"raft with a load": (raft, (1e-3, .01, .1, .3)), "ten boxes": (stack, HEAVY), "light below heavy": (stack_of_unequals, LIGHT),
           "arch of wedges": (arch, (1.5, 10., 1e3)), "box under a roof": (roof, LIGHT), "cork between shelves": (cork, LIGHT),
           "slope, .99 of the limit": (holding, (*LIGHT, *HEAVY))}


def run(case, ratio, dimension, step, steps=20, **options):
    """Largest speed of bodies in the second half of the steps over sqrt(g L); the water's energy over that of a tank full of it that falls by
    its length; the error of momentum; solves a phase; phases with contact outside of the solve."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        tank = Tank(dimension, folder)
        case(tank, ratio)
        (folder / "scene.xml").write_text(tank.scene(step, **options))
        done = attempt(folder / "scene.xml", folder / "output", "--steps", steps, seconds=600)
        assert done.returncode == 0, f"{case.__name__}, ratio {ratio}: {done.stdout[-1000:]}"
        bodies, history = table(folder / "output/bodies.csv"), table(folder / "output/history.csv")
    late = [row for row in bodies if int(row["step"]) > steps // 2]
    speed = max(abs(value) for axis in ("vx", "vy", "vz")[:dimension] for value in column(late, axis))
    return {"speed": speed / math.sqrt(G), "energy": max(column(history, "fluid_kinetic_energy")[steps // 2:]) / (1000 * G),
            "momentum": max(column(history, "momentum_error")), "solves": sum(column(history, "contact_solves")) / (2 * steps),
            "outside": sum(column(history, "contacts_outside"))}
