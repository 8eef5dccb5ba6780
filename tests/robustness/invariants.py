"""Invariants of every valid scene. Each check gives sentences, `class: numbers`; none if all is well.

| class | bound |
|---|---|
| momentum, angular momentum | LEDGER of the step's scale (docs/method.md, the ledger) |
| liquid | its volume is what known fluxes make of it, to LIQUID or what one closed void holds |
| divergence | DIVERGENCE of the largest speed over a cell; with tension or gas, which push over down to 1e-5 of a cell and so set the scale of a solve, DIVERGENCE_PUSHED |
| contact | what touches moves into it by at most CONTACT of the largest speed, where contacts are part of the coupled solve |
| finite | every number of history.csv, bodies.csv and of all frames |
| scalar | smoke and temperature between their least and most initial, inflowing and held values |
| energy | kinetic and elastic, at most GROWTH times the start's and gravity's work, where nothing else does work |
| rotated copy | bodies and energies equal, as ranks', of the scene with its axes turned (rotated_copies.py) |
| ranks | bodies and energies equal on 1, 2 and 3 ranks to RANKS of their scale, once contact decides by inequalities to RANKS_IN_CONTACT, or to CHAOS times what another tolerance, or a density by 1e-12 of itself, changes on one rank |
| restart | tables and last frame bit for bit |
"""
import math

import h5py
import numpy

from runs import read_table

LEDGER = 1e-10
LIQUID = 5e-2  # scenes of some hundred cells; a shift mends a fifth of a cell a step
SMALLEST_VOID = {2: 8, 3: 27}  # cells, the default
FASTEST_OF_FRACTIONS = 2  # cells a step
CONTACT = 1e-3  # contacts are decided to 1e-5 of what gravity adds in a step, which a speed is at least; beside closed fluid to 1e-3
DIVERGENCE = 1e-6
DIVERGENCE_PUSHED = 1e-5
RANKS = 1e-6
RANKS_IN_CONTACT = 1e-2
CUBIC_IMAGES = 1e-3  # near surfaces cubic rays become linear ones; where, is told by cells, which do not turn about points
CHAOS = 10
# The largest amplification of a mode's energy by the scheme's own map in any number of steps: implicit schemes at any
# step; explicit ones at 0.9 of their stable step. A twentieth more for the clamped interpolation of advection.
GROWTH = 1.15 * 1.05
GROWTH_EXPLICIT = 2.07 * 1.05
ROUND_OFF = 1e-9
# Part of the energy that the scene gives the fluid at the start: a velocity that is no flow is advected for a step before it
# becomes one, and leaves so much of itself.
NO_FLOW = 1e-3
# Columns in which a number's size says nothing of an error.
COUNTS = ("step", "time", "name", "wall_seconds", "contacts", "deepest_overlap", "contact_solves", "contacts_outside", "contact_residual", "clamped_elements")


def columns(rows, prefix):
    """The components of a vector, a list for each row."""
    names = [f"{prefix}_{a}" for a in "xyz" if f"{prefix}_{a}" in rows[0]]
    return numpy.array([[float(row[name]) for name in names] for row in rows])


def number(rows, name):
    return numpy.array([float(row[name]) for row in rows])


class Tables:
    """history.csv and bodies.csv of a finished run."""

    def __init__(self, folder):
        self.folder = folder
        self.history = read_table(folder / "history.csv")
        self.bodies = read_table(folder / "bodies.csv")
        known = {"history.csv", "bodies.csv"}
        self.observed = {path.name: read_table(path) for path in sorted(folder.glob("*.csv")) if path.name not in known}

    def kinetic_energy(self):
        return sum(number(self.history, f"{kind}_kinetic_energy") for kind in ("fluid", "solid"))

    def energy(self):
        return self.kinetic_energy() + number(self.history, "elastic_energy")


def scales(scene, tables):
    """Scales of positions, velocities, turns and energies of a scene."""
    domain = scene.content["Domain"]
    length = max(b - a for a, b in zip(domain["Lower"], domain["Upper"]))
    h = length / max(domain["Cells"])
    speed = (number(tables.history, "cfl") * h / number(tables.history, "dt")).max()
    bodies = tables.bodies
    for c in ("vx", "vy", "vz"):
        if bodies and c in bodies[0]:
            speed = max(speed, abs(number(bodies, c)).max())
    fluid = scene.content["Fluid"]
    gravity = math.hypot(*fluid.get("Gravity", [0.0]))
    tension = fluid.get("Free Surface", {}).get("Surface Tension", 0) / (fluid["Density"] * h ** 2)
    speed = max(speed, 1e-3 * h / scene.dt, gravity * scene.dt, tension * scene.dt)
    return length, h, speed


def start_speed(scene, tables):
    """The largest sum of the components of the fluid's velocity."""
    domain, first = scene.content["Domain"], tables.history[0]
    h = max((b - a) / n for a, b, n in zip(domain["Lower"], domain["Upper"], domain["Cells"]))
    return float(first["cfl"]) * h / float(first["dt"])


def largest_void(scene):
    """Volume that filling an air component may add in one step, for the steps after it to take back."""
    domain, dimension = scene.content["Domain"], scene.content["Dimension"]
    h = (domain["Upper"][0] - domain["Lower"][0]) / domain["Cells"][0]
    return SMALLEST_VOID[dimension] * h**dimension


def keeps_up(interface, history):
    """Not where volume is only measured. Fractions that solids or inflows displace over several cells in a step are paid
    back over the steps after it."""
    if interface["Type"] == "volume of fluid":
        return number(history, "cfl").max() < FASTEST_OF_FRACTIONS
    return interface.get("Volume Correction") != "none"


def check_tables(scene, tables):
    history = tables.history
    steps = [int(row["step"]) for row in history]
    if steps != list(range(1, len(steps) + 1)) or len(steps) != scene.n_steps:
        yield f"tables: steps {steps} of {scene.n_steps}"
        return
    for name, rows in {"history.csv": history, "bodies.csv": tables.bodies, **tables.observed}.items():
        for row in rows:
            bad = [c for c, text in row.items() if c != "name" and not math.isfinite(float(text))]
            if bad:
                yield f"finite: {bad} of {name} in step {row['step']}"
                return
    if scene.facts.exact_momentum:
        for kind in ("momentum", "angular_momentum"):
            worst = number(history, f"{kind}_error").max()
            if worst > LEDGER:
                yield f"{kind.replace('_', ' ')}: error {worst:.1e}"
    if scene.facts.liquid and keeps_up(scene.content["Fluid"]["Free Surface"]["Interface"], history):
        target = number(history, "liquid_volume_target")
        worst = abs(number(history, "liquid_volume") - target).max()
        if worst > max(LIQUID * abs(target).max(), largest_void(scene)):
            yield f"liquid: off by {worst / abs(target).max():.1e} of its volume"
    _, h, speed = scales(scene, tables)
    worst = (number(history, "contact_residual") * (number(history, "contacts_outside") == 0)).max() / speed
    if worst > CONTACT:
        yield f"contact: {worst:.1e} of the speed into what touches"
    worst = number(history, "max_divergence").max() * h / speed
    is_pushed = "Surface Tension" in scene.xml or "Trapped Air" in scene.xml
    if worst > (DIVERGENCE_PUSHED if is_pushed else DIVERGENCE):
        yield f"divergence: {worst:.1e} of the speed over a cell"


def check_frames(scene, tables):
    """All fields of all frames."""
    lowest, highest = {}, {}
    with h5py.File(tables.folder / "frames.h5") as file:
        frames = sorted(name for name in file if name.startswith("frame-"))
        if len(frames) != len(tables.history) + 1:
            yield f"tables: {len(frames)} frames of {len(tables.history)} steps"
        for frame in frames:
            found = {}
            file[frame].visititems(lambda name, item: found.update({name: item[...]})
                                   if isinstance(item, h5py.Dataset) else None)
            for name, values in found.items():
                if values.dtype.kind == "f" and not numpy.isfinite(values).all():
                    yield f"finite: {name} of {frame}"
                    return
            for name in scene.facts.scalar_range:
                inside = found[f"fluid/{name}"][found["fluid/fluid"] > 0] if "fluid/fluid" in found else []
                if len(inside):
                    lowest[name] = min(lowest.get(name, math.inf), inside.min())
                    highest[name] = max(highest.get(name, -math.inf), inside.max())
    for name, (least, most) in scene.facts.scalar_range.items():
        slack = ROUND_OFF * max(abs(least), abs(most))
        if name in lowest and (lowest[name] < least - slack or highest[name] > most + slack):
            yield f"scalar: {name} from {lowest[name]:.6g} to {highest[name]:.6g}, not in [{least:.6g}, {most:.6g}]"


def has_energy_bound(scene):
    """Without the last step's pressure the viscous solve sees gravity unbalanced and moves fluid at rest (docs/method.md)."""
    fluid = scene.content["Fluid"]
    moves_at_rest = (scene.content["Time"].get("Pressure Correction") == "non-incremental" and "Viscosity" in fluid and
                     any(fluid.get("Gravity", [])))
    return not (scene.facts.works or scene.facts.open_sides or moves_at_rest)


def check_energy(scene, tables, start):
    """`start` is a run with a tiny step. Gravity's work is bounded by its impulse on the momentum at both ends of each
    step. Sub-steps soften modes that the step cannot carry: what these store of the strain counts at the start only."""
    gravity = numpy.array(scene.content["Fluid"].get("Gravity", [0.0] * scene.content["Dimension"]))
    momentum = columns(tables.history, "fluid_momentum") + columns(tables.history, "solid_momentum")
    power = numpy.maximum(momentum @ gravity, 0)
    power = numpy.maximum(power, numpy.concatenate([[power[0]], power[:-1]]))
    work = numpy.cumsum(power * number(tables.history, "dt"))
    start_energy = start.energy()[0]
    allowed = (GROWTH_EXPLICIT if scene.facts.explicit else GROWTH) * (start_energy + work)
    allowed += max(ROUND_OFF * energy_at_speed(scene, scales(scene, tables)[2]),
                   NO_FLOW * energy_at_speed(scene, start_speed(scene, tables)))
    energy = tables.kinetic_energy() if scene.facts.sub_steps else tables.energy()
    worst = int(numpy.argmax(energy - allowed))
    if energy[worst] > allowed[worst] * (1 + ROUND_OFF):
        yield (f"energy: {energy[worst]:.4g} J after step {worst + 1}, of {start_energy:.4g} J at the start and "
               f"{work[worst]:.3g} J of gravity")


def touched(*runs):
    return any(int(row["contacts"]) for tables in runs for row in tables.history)


def energy_at_speed(scene, speed):
    domain = scene.content["Domain"]
    volume = math.prod(b - a for a, b in zip(domain["Lower"], domain["Upper"]))
    return scene.content["Fluid"]["Density"] * volume * speed ** 2 / 2


def check_same(scene, one, other, kind, twin=None):
    """Bodies and energies; forces and residuals are differences of these and carry the solver's tolerance over dt.
    `twin`, on one rank too, was disturbed by as much as solves are inexact: others may part CHAOS times as far."""
    _, h, speed = scales(scene, one)
    energy = max(one.energy().max(), ROUND_OFF * energy_at_speed(scene, speed))
    compared = [("history", c, energy) for c in ("fluid_kinetic_energy", "solid_kinetic_energy", "elastic_energy")]
    compared += [("history", "dt", scene.dt)]
    for c in "xyz":
        compared += [("bodies", c, h), ("bodies", "v" + c, speed), ("bodies", "w" + c, speed / h)]
    bound = RANKS_IN_CONTACT if touched(one, other) else RANKS
    if kind == "rotated copy" and scene.content["Fluid"]["Advection"] == "cubic":
        bound = max(bound, CUBIC_IMAGES)
    for table, column, scale in compared:
        mine, theirs = getattr(one, table), getattr(other, table)
        if len(mine) != len(theirs):
            yield f"{kind}: {len(theirs)} rows of {table}.csv, not {len(mine)}"
            return
        if not mine or column not in mine[0]:
            continue
        apart = abs(number(mine, column) - number(theirs, column)).max() / scale
        disturbed = abs(number(mine, column) - number(getattr(twin, table), column)).max() / scale if twin else 0
        if not apart <= max(bound, CHAOS * disturbed):
            yield f"{kind}: {column} of {table}.csv differs by {apart:.1e}"
            return


def check_restart(straight, restarted):
    """Text for text, and the last frame bit for bit."""
    for table in ("history", "bodies"):
        mine, theirs = ([{c: text for c, text in row.items() if c != "wall_seconds"} for row in getattr(t, table)]
                        for t in (straight, restarted))
        if mine != theirs:
            different = sorted({c for a, b in zip(mine, theirs) for c in a if a[c] != b[c]})
            yield f"restart: {table}.csv differs in {different or 'its rows'}"
            return
    if straight.observed != restarted.observed:
        yield "restart: what observers saw differs"
        return
    fields = []
    for tables in (straight, restarted):
        with h5py.File(tables.folder / "frames.h5") as file:
            last, found = sorted(name for name in file if name.startswith("frame-"))[-1], {}
            file[last].visititems(lambda name, item: found.update({name: item[...].tobytes()})
                                  if isinstance(item, h5py.Dataset) else None)
            fields.append(found)
    if fields[0] != fields[1]:
        yield "restart: the last frame differs"
