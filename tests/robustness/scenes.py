"""Random valid scenes: `random_scene(seed)` is a pure function, so a seed names a scene for ever.

Every scene is valid by docs/parameters: no inflow without an open side, no overlap at the start but where nodes are
glued to a body, no strategy outside its domain (docs/solvers.md). Sizes follow from the grid: speeds from the cells
crossed in a step, stiffnesses from the cells that a wave crosses, densities from that of the fluid.
"""
import dataclasses
import math
import random

import gases
import joints
import liquids
import long_tension
import phases
import resting
import seams
import second_order
import solvers
from liquids import AXES
from parameter_list import to_xml
from rigid_solids import rigid_body
from soft_solids import carried, cloth, deformable_body

NAMES = ["Ball", "Body 2", "x,y 1", "A & B", "Körper", "Körper 2", "b-3", "Zelt"]


@dataclasses.dataclass
class Facts:
    """Properties of a scene that the invariants use."""
    works: bool = False  # something besides gravity does work on it
    through_side: bool = False  # a body sticks through a side
    open_sides: bool = False
    inflow: bool = False
    periodic: bool = False
    explicit: bool = False  # elastic forces of the present positions
    sub_steps: bool = False  # elastic forces are averaged over sub-steps
    crushed: bool = False  # a material that gives way where it is crushed, at steps that crush it
    liquid: bool = False  # with a free surface
    soft: bool = False
    springs: bool = False
    attached: bool = False
    closed_shell: bool = False
    dynamic_rigid: bool = False
    exact_momentum: bool = True
    strategy: str = ""
    pressure_by_muelu: bool = False  # A + B C^-1 B^T, which Chebyshev's polynomials may take for smaller than it is
    solid_by_muelu: bool = False  # on several ranks MueLu cannot multiply matrices of which one holds no neighbours
    massless: bool = False  # a cloth, of which the fluid may leave nodes without any
    scalar_range: dict = dataclasses.field(default_factory=dict)  # smoke, temperature: [least, most]
    lightest: float = math.inf  # density of a solid over that of the fluid


@dataclasses.dataclass
class Scene:
    seed: int
    xml: str
    files: dict  # name -> text, beside the scene
    facts: Facts
    content: dict
    n_steps: int
    dt: float


class World:
    """The scales of a scene, and what its parts draw from."""

    def __init__(self, seed):
        rng = self.rng = random.Random(f"lockstep scene {seed}")
        self.facts, self.files, self.names = Facts(), {}, rng.sample(NAMES, len(NAMES))
        self.dimension = 2 if rng.random() < 0.6 else 3
        self.cells = ([rng.randint(8, 36), rng.randint(8, 20)] if self.dimension == 2 else
                      [rng.randint(7, 17), rng.randint(7, 9), rng.randint(7, 9)])
        rng.shuffle(self.cells)
        size = 1.0 if rng.random() < 0.5 else 10 ** rng.uniform(-2, 2)
        self.h = size / max(self.cells)
        self.lower = [rng.choice([0.0, 0.0, rng.uniform(-2, 2) * size]) for _ in self.cells]
        self.upper = [a + n * self.h for a, n in zip(self.lower, self.cells)]
        self.density = rng.choice([1.0, 1000.0, 10 ** rng.uniform(-1, 4)])
        self.speed = 10 ** rng.uniform(-1, 0.5) * size
        self.cfl = rng.choice([0.2, 0.5, 0.9, 2.0, 5.0])
        self.dt = self.cfl * self.h / self.speed
        self.n_steps = rng.randint(3, 5)
        self.start = rng.choice([0.0, 0.0, 0.0, self.dt, -0.5 * self.dt])
        self.isolated = rng.random() < 0.3  # nothing but gravity does work: energy is bounded

    def vector(self, length):
        """A vector of at most this length, in a random direction."""
        direction = [self.rng.gauss(0, 1) for _ in range(self.dimension)]
        scale = length * self.rng.uniform(0.2, 1) / math.hypot(*direction)
        return [scale * x for x in direction]

    def rotation(self, rate):
        """A number in 2D, a vector in 3D."""
        return self.rng.uniform(-rate, rate) if self.dimension == 2 else self.vector(rate)

    def does_work(self, probability):
        """True with this probability, where work may be done; then Facts know."""
        if self.rng.random() >= probability or self.isolated:
            return False
        self.facts.works = True
        return True

    def density_ratio(self):
        ratio = self.rng.choice([1.0, 10 ** self.rng.uniform(-2, 2), 10 ** self.rng.uniform(-1, 1)])
        self.facts.lightest = min(self.facts.lightest, ratio)
        return ratio

    def add_file(self, extension, text):
        name = f"mesh-{len(self.files) + 1}.{extension}"
        self.files[name] = text
        return name

    def new_name(self):
        return self.names.pop()


def sides(world):
    """Pairs of closed, periodic, open sides and inflows; an inflow has an open side to leave through."""
    rng, lists = world.rng, {}
    kinds = {}
    choices = ["closed"] * 4 + ["periodic"] + ([] if world.isolated else ["open", "stream"])
    for axis in range(world.dimension):
        kind = rng.choice(choices)
        names = [f"{AXES[axis]} lower", f"{AXES[axis]} upper"]
        if kind == "periodic":
            kinds.update({name: {"Type": "periodic"} for name in names})
        elif kind == "open":
            rng.shuffle(names)
            kinds[names[0]] = {"Type": "open"}
            kinds[names[1]] = {"Type": rng.choice(["open", "wall", "slip wall"])}
        elif kind == "stream":
            end = rng.randrange(2)
            kinds[names[end]] = inflow(world, axis, end)
            kinds[names[1 - end]] = {"Type": "open"}
        else:
            kinds.update({name: {"Type": rng.choice(["wall", "wall", "slip wall"])} for name in names})
    for name, side in kinds.items():
        axis = AXES.index(name[0])
        if side["Type"] == "wall" and world.does_work(0.15):
            side["Velocity"] = world.vector(0.5 * world.speed)
            side["Velocity"][axis] = 0.0
            ramp = f"min(max(t/{rng.uniform(0, 2) * world.dt}, 0), 1)" if rng.random() < 0.3 else "1"
            if rng.random() < 0.2:
                ramp += f"*(t > {world.start + rng.uniform(0, 4) * world.dt} ? 0 : 1)"
            if ramp != "1":
                side["Velocity"] = [f"{v}*{ramp}" if v else "0" for v in side["Velocity"]]
        lists[name] = side
    world.facts.open_sides = any(side["Type"] in ("open", "inflow") for side in kinds.values())
    world.facts.periodic = any(side["Type"] == "periodic" for side in kinds.values())
    return lists


def inflow(world, axis, end):
    rng = world.rng
    velocity = [0.0] * world.dimension
    velocity[axis] = (1 if end == 0 else -1) * rng.uniform(0.2, 1) * world.speed
    side = {"Type": "inflow", "Velocity": velocity}
    factors = []
    if rng.random() < 0.3:
        factors += [f"6*(({a}) - ({lower}))*(({upper}) - ({a}))/({(upper - lower) ** 2})"
                    for a, lower, upper in zip(AXES, world.lower, world.upper) if AXES.index(a) != axis]
    if rng.random() < 0.3:
        factors.append(f"min(max(t/{rng.uniform(0, 3) * world.dt}, 0), 1)")
    if factors:
        side["Velocity"] = ["*".join([str(v), *factors]) if v else "0" for v in velocity]
    if rng.random() < 0.3:
        middle = [(a + b) / 2 for a, b in zip(world.lower, world.upper)]
        half = [rng.uniform(0.25, 0.45) * (b - a) for a, b in zip(world.lower, world.upper)]
        half[axis] = world.upper[axis] - world.lower[axis]
        side["Opening"] = {"Lower": [m - x for m, x in zip(middle, half)],
                           "Upper": [m + x for m, x in zip(middle, half)]}
    world.facts.works = world.facts.inflow = True
    return side


def region(world):
    """A box or a ball in the domain."""
    rng = world.rng
    point = [rng.uniform(a, b) for a, b in zip(world.lower, world.upper)]
    if rng.random() < 0.5:
        return {"Shape": "ball", "Center": point, "Radius": rng.uniform(1, 4) * world.h}
    return {"Shape": "box", "Lower": [x - rng.uniform(1, 4) * world.h for x in point],
            "Upper": [x + rng.uniform(1, 4) * world.h for x in point]}


def scalars(world, fluid, side_lists):
    """Smoke and temperature with their regions, sources and weights; Facts.scalar_range."""
    rng = world.rng
    for name, weight in (("Smoke", "Smoke Weight"), ("Temperature", "Thermal Expansion")):
        if rng.random() > 0.3:
            continue
        ambient = rng.choice([0.0, rng.uniform(-1, 1)])
        values = [ambient]
        fluid[name] = {"Ambient": ambient}
        if rng.random() < 0.7:
            values.append(rng.uniform(0, 2))
            fluid[name]["Regions"] = {"Puff": {**region(world), "Value": values[-1]}}
        for side in side_lists.values():
            if side["Type"] == "inflow":
                side[name] = rng.uniform(0, 1)
                values.append(side[name])
        values.append(0.0)  # speed of the inflow through an open side
        if rng.random() < 0.5:
            source = {**region(world), name: rng.uniform(0, 2)}
            values.append(source[name])
            if world.does_work(0.4):
                source["Velocity"] = world.vector(0.3 * world.speed)
            if rng.random() < 0.3:
                source["Start"] = world.start + world.dt
            fluid.setdefault("Sources", {})[f"Source of {name}"] = source
        if rng.random() < 0.2:
            values.append(rng.uniform(0, 1))
            fluid.setdefault("Sources", {})[f"Second source of {name}"] = {**region(world), name: values[-1]}
        if world.does_work(0.5):
            fluid[weight] = rng.uniform(0, 0.3) * (1 if name == "Temperature" else rng.choice([-1, 1]))
        world.facts.scalar_range[name.lower()] = [min(values), max(values)]


def fluid(world, side_lists):
    rng = world.rng
    chosen = {"Type": "mac", "Density": world.density, "Advection": rng.choice(["semi-lagrangian", "maccormack", "cubic"]),
              "Order in Time": rng.choice([1, 2])}
    if rng.random() < 0.5:
        chosen["Viscosity"] = world.density * world.h ** 2 / world.dt * 10 ** rng.uniform(-3, 1)
    if rng.random() < 0.2:
        chosen["Smallest Link"] = rng.uniform(0.05, 1)
    if rng.random() < 0.6:
        chosen["Gravity"] = world.vector(world.speed / world.dt / 5)
    if world.does_work(0.15):
        chosen["Body Force"] = world.vector(world.speed / world.dt / 10)
    scalars(world, chosen, side_lists)
    state = rng.choice(["at rest", "at rest", "uniform", "taylor green", "rotation"])
    length = max(b - a for a, b in zip(world.lower, world.upper))
    if state == "uniform":
        chosen["Velocity"] = world.vector(world.speed)
    elif state == "taylor green":
        amplitude, k = 0.7 * world.speed, 2 * math.pi / length * rng.choice([1, 2])
        chosen["Velocity"] = [f"{amplitude}*sin({k}*x)*cos({k}*y)", f"-{amplitude}*cos({k}*x)*sin({k}*y)", "0"][:world.dimension]
    elif state == "rotation":
        rate = world.rotation(world.speed / length)
        center = [(a + b) / 2 for a, b in zip(world.lower, world.upper)]
        arm = [f"({axis} - ({middle}))" for axis, middle in zip("xyz", center)]
        w = [f"({w})" for w in (rate if world.dimension == 3 else [0, 0, rate])]
        chosen["Velocity"] = [f"{w[1]}*{arm[2]} - {w[2]}*{arm[1]}", f"{w[2]}*{arm[0]} - {w[0]}*{arm[2]}",
                              f"{w[0]}*{arm[1]} - {w[1]}*{arm[0]}"] if world.dimension == 3 else [f"-{w[2]}*{arm[1]}", f"{w[2]}*{arm[0]}"]
    return chosen


def slots(world, n):
    """Centres and half widths of n equal parts of the domain along its longest axis, a margin inside them."""
    axis = world.cells.index(max(world.cells))
    n = min(n, world.cells[axis] // 7)
    if n == 0:
        return
    part = (world.upper[axis] - world.lower[axis]) / n
    narrowest = min(part, *(b - a for a, b in zip(world.lower, world.upper)))
    reach = narrowest / 2 - 1.2 * world.h
    for k in range(n):
        center = [(a + b) / 2 for a, b in zip(world.lower, world.upper)]
        center[axis] = world.lower[axis] + (k + 0.5) * part
        yield [x + world.rng.uniform(-0.2, 0.2) * world.h for x in center], reach


def solids(world):
    rng, lists = world.rng, {}
    for center, reach in slots(world, rng.choice([0, 1, 1, 1, 2, 2, 3])):
        kind = rng.choice(["rigid"] * 4 + ["soft"] * 3 + ["cloth"] * 3 + ["carried"])
        if kind == "carried":
            lists.update(carried(world, center, reach))
        else:
            make = {"rigid": rigid_body, "soft": deformable_body, "cloth": cloth}[kind]
            lists[world.new_name()] = make(world, center, reach)
    if lists and rng.random() < 0.07:
        put_through_side(world, rng.choice(list(lists.values())))
    for body in lists.values():
        if rng.random() < 0.3:
            body.update({"Restitution": rng.uniform(0, 1), "Friction": rng.uniform(0, 1)})
    return lists


def put_through_side(world, body):
    """Moves a rigid body across a side that nothing enters through; what it says of motion stays."""
    axis, end = world.rng.randrange(world.dimension), world.rng.choice(["lower", "upper"])
    if body["Type"] == "rigid body" and not world.facts.attached and not world.facts.inflow:
        body["Position"][axis] = getattr(world, end)[axis] + world.rng.uniform(-0.5, 0.5) * world.h
        world.facts.through_side = True


def coupling(world):
    rng = world.rng
    if rng.random() < 0.4:
        chosen = {"Type": "flux", "Weights": rng.choice(["face fractions", "volume fractions"])}
        if rng.random() < 0.3:
            chosen["Smallest Open Fraction"] = 10 ** rng.uniform(-6, -0.5)
        if rng.random() < 0.2:
            chosen["Correct Buoyancy"] = False
        return chosen
    lumping = rng.choice(["diagonal"] * 4 + ["consistent"] * 3 + ["paper diagonal"])
    if lumping == "paper diagonal":
        world.facts.exact_momentum = False
    return {"Type": "mixed face", "Mixed Rule": rng.choice(["voxel", "voxel", "every cut cell"]), "Lumping": lumping,
            "Weights": rng.choice(["barycentric", "rigid motions"]),
            "Fluid Mass": rng.choice(["fluid part", "fluid part", "whole cell"]), "Correct Buoyancy": rng.random() < 0.8}


def contact(world, solid_lists):
    """None where nodes are glued or a body sticks through a wall: those overlap from the start."""
    rng = world.rng
    if world.facts.attached or world.facts.through_side or rng.random() < 0.4:
        return {"Type": "none"}
    chosen = {"Type": "gauss seidel"}
    if rng.random() < 0.3:
        rng.uniform(0.05, 0.3)  # drawn once for a parameter that is no more: seeds keep their scenes
        chosen["Thickness"] = rng.uniform(0.05, 0.2)
        rng.random()  # keeps the draws of the scenes that follow
    if rng.random() < 0.2:
        chosen["Walls"] = {"Friction": rng.uniform(0, 1), "Restitution": rng.uniform(0, 1)}
    if solid_lists and rng.random() < 0.2:
        chosen["Skins"] = {rng.choice(sorted(solid_lists)): {"Thickness": rng.uniform(0.05, 0.2) * world.h}}
    return chosen


def time(world):
    rng = world.rng
    chosen = {"Start": world.start, "End": world.start + 100 * world.dt, "Steps": world.n_steps,
              "Pressure Correction": rng.choice(["rotational", "incremental", "non-incremental"])}
    if rng.random() < 0.6:
        chosen["Fixed Step"] = world.dt
    else:
        chosen.update({"CFL": world.cfl, "Largest Step": world.dt})
    return chosen


def observers(world):
    """At most one of each type, at places in the domain."""
    rng, lists = world.rng, {}

    def place():
        return [rng.uniform(a, b) for a, b in zip(world.lower, world.upper)]

    if rng.random() < 0.15:
        lists["probes"] = {"Type": "points", "Points": place() + place()}
    if rng.random() < 0.15:
        lists["plane"] = {"Type": "box", "Lower": world.lower, "Upper": place(),
                          "Count": [rng.randint(1, 4) for _ in world.cells]}
    if rng.random() < 0.15:
        lower, upper = map(list, zip(*(sorted(pair) for pair in zip(place(), place()))))
        axis = rng.randrange(world.dimension)
        upper[axis] = lower[axis]
        lists["window"] = {"Type": "flow", "Lower": lower, "Upper": upper, "Interval": rng.choice([0.0, 2 * world.dt])}
    return lists


def random_scene(seed):
    """The scene that this seed names, as a Scene."""
    world = World(seed)
    at_seam, rests = seams.FIRST_SEED <= seed < resting.FIRST_SEED, resting.FIRST_SEED <= seed < phases.FIRST_SEED
    if at_seam:
        seams.fill_tiles(world)
    side_lists = sides(world)
    if at_seam:
        seams.close_ring(world, side_lists)
    content = {"Dimension": world.dimension, "Title": f"Random scene {seed}",
               "Domain": {"Lower": world.lower, "Upper": world.upper, "Cells": world.cells, "Sides": side_lists},
               "Fluid": fluid(world, side_lists), "Solids": {} if rests else solids(world)}
    if at_seam:
        seams.move_to_seam(world, content["Solids"], seed)
    elif liquids.FIRST_SEED <= seed < joints.FIRST_SEED or seed >= gases.FIRST_SEED:
        liquids.fill_with_liquid(world, content, seed)
    if long_tension.FIRST_SEED <= seed < seams.FIRST_SEED:
        long_tension.lengthen(world, content, seed)
    elif gases.FIRST_SEED <= seed < seams.FIRST_SEED:
        gases.trap_air(world, content, seed)
    elif rests:
        resting.lay_down(world, content, seed)
    elif seed >= phases.FIRST_SEED:
        phases.give_air_mass(world, content, seed)
    if seed >= second_order.FIRST_SEED:
        second_order.keep_rigid(content)
    content["Coupling"] = coupling(world)
    content["Contact"] = contact(world, content["Solids"])
    if rests:
        content["Contact"]["Type"] = "gauss seidel"
    if joints.FIRST_SEED <= seed < gases.FIRST_SEED:
        joints.add_joints(world, content, seed)
    content["Solver"] = solvers.solver(world, content["Coupling"], content["Solids"])
    content["Time"] = time(world)
    if seed >= second_order.FIRST_SEED:
        second_order.set_order(content)
    content["Observers"] = observers(world)
    content["Output"] = {"Precision": "double", "Checkpoints": {"Interval": 1e-9 * world.dt, "Count": 10}}
    return Scene(seed, to_xml("Scene", content), world.files, world.facts, content, world.n_steps, world.dt)
