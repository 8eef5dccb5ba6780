"""Seeds from FIRST_SEED on have joints: between the rigid bodies of the scene, to space, and to limbs that the fluid does
not see. They draw from numbers of their own, so that no other seed changes."""
import math
import random

FIRST_SEED = 3000
KINDS = {2: ["hinge", "hinge", "slider", "weld"],
         3: ["ball", "ball", "hinge", "hinge", "universal", "slider", "cylinder", "planar", "weld"]}
NEEDS_AXIS = {2: {"slider"}, 3: {"hinge", "universal", "slider", "cylinder", "planar"}}
PRESCRIBED = "Motion"


def direction(rng, dimension):
    vector = [rng.gauss(0, 1) for _ in range(dimension)]
    return [x / math.hypot(*vector) for x in vector]


def across(rng, axis):
    """At right angles to an axis of length one."""
    other = direction(rng, 3)
    along = sum(a * b for a, b in zip(axis, other))
    other = [b - along * a for a, b in zip(axis, other)]
    return [x / math.hypot(*other) for x in other]


def joint(rng, dimension, first, second, point):
    kind = rng.choice(KINDS[dimension])
    chosen = {"Type": kind, "Solids": [first, second], "Point": point}
    if kind in NEEDS_AXIS[dimension]:
        chosen["Axis"] = direction(rng, dimension)
    if kind == "universal":
        chosen["Second Axis"] = across(rng, chosen["Axis"])
    return chosen


def beside(rng, world, place, distance):
    return [x + distance * world.h * d for x, d in zip(place, direction(rng, world.dimension))]


def limb(rng, world, place):
    """A bone: a mass that joints alone move."""
    body = {"Type": "rigid body", "Geometry": {"Shape": "box", "Size": [rng.uniform(1, 4) * world.h for _ in world.cells]},
            "Position": place, "Mass": world.density * world.h ** world.dimension * 10 ** rng.uniform(-2, 2),
            "Seen by Fluid": False}
    if rng.random() < 0.5:
        body["Velocity"] = [0.3 * world.speed * d for d in direction(rng, world.dimension)]
    return body


COORDINATES = {"hinge": 1, "slider": 1, "universal": 2, "cylinder": 2, "planar": 3}


def add_limits(content, seed):
    """To every other joint, where there is contact to keep them; a loop keeps a joint that is free."""
    rng = random.Random(f"lockstep limits {seed}")
    if content.get("Contact", {}).get("Type") == "none":
        return
    for number, one in enumerate(content["Joints"].values()):
        if number % 2 == 0 or one["Type"] == "weld":
            continue
        if one["Type"] == "ball":
            one["Limits"] = {"Upper": rng.uniform(.01, 1.)}
            continue
        n = COORDINATES[one["Type"]]
        one["Limits"] = {}
        for side, sign in (("Lower", -1), ("Upper", 1)):
            values = [sign * 10 ** rng.uniform(-3, 0) for _ in range(n)]
            one["Limits"][side] = values if n > 1 else values[0]


def add_joints(world, content, seed):
    rng = random.Random(f"lockstep joints {seed}")
    solids, joints = content["Solids"], {}
    bodies = [name for name, body in solids.items() if body["Type"] == "rigid body" and "," not in name]
    for name in bodies:
        if PRESCRIBED not in solids[name]:
            solids[name].pop("Locked", None), solids[name].pop("Pivot", None)
    for first, second in zip(bodies, bodies[1:]):
        if rng.random() < 0.7 and not all(PRESCRIBED in solids[name] for name in (first, second)):
            middle = [(a + b) / 2 for a, b in zip(solids[first]["Position"], solids[second]["Position"])]
            joints[f"Joint {len(joints)}"] = joint(rng, world.dimension, first, second, middle)
    free = [name for name in bodies if PRESCRIBED not in solids[name]]
    if free and rng.random() < 0.4:
        point = beside(rng, world, solids[free[0]]["Position"], 2)
        joints[f"Joint {len(joints)}"] = joint(rng, world.dimension, "space", free[0], point)
    hosts = list(bodies)
    for k in range(rng.randint(0, 3)):
        host = rng.choice(hosts) if hosts else "space"
        place = solids[host]["Position"] if host != "space" else [(a + b) / 2 for a, b in zip(world.lower, world.upper)]
        name, point = f"Limb {k}", beside(rng, world, place, rng.uniform(0, 4))
        solids[name] = limb(rng, world, beside(rng, world, point, rng.uniform(0, 3)))
        ends = [host, name] if rng.random() < 0.7 or host == "space" else [name, host]
        joints[f"Joint {len(joints)}"] = joint(rng, world.dimension, *ends, point)
        hosts.append(name)
    if not joints:
        return
    content["Joints"] = joints
    add_limits(content, seed)
    if any(PRESCRIBED in solids.get(name, {}) for one in joints.values() for name in one["Solids"]):
        world.facts.works = True
    if content["Coupling"].get("Lumping") == "paper diagonal":
        content["Coupling"]["Lumping"] = "diagonal"
        world.facts.exact_momentum = True
    if rng.random() < 0.3:
        content["Articulation"] = {"Impulses": "end of step"}
