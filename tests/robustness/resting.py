"""Seeds from FIRST_SEED on are scenes of water in which rigid bodies lie on the floor and on each other, or fall a little to
get there. They draw from numbers of their own, so that no other seed changes."""
import math
import random

from liquids import AXES

FIRST_SEED = 8000
WIDTH = 7  # cells of a column of bodies


def columns(world, floor_axis):
    """Places on the floor, one behind the other along the longest axis of it."""
    across = [axis for axis in range(world.dimension) if axis != floor_axis]
    longest = max(across, key=lambda axis: world.cells[axis])
    n = max(1, min(3, world.cells[longest] // WIDTH))
    for k in range(n):
        place = [(a + b) / 2 for a, b in zip(world.lower, world.upper)]
        place[longest] = world.lower[longest] + (k + 0.5) / n * (world.upper[longest] - world.lower[longest])
        yield place


def body(rng, world, floor_axis):
    """A ball or an upright box, and its height."""
    ratio = 10 ** rng.uniform(-0.5, 1.5)
    world.facts.lightest = min(world.facts.lightest, ratio)
    drawn = {"Type": "rigid body", "Density": ratio * world.density}
    if rng.random() < 0.4:
        radius = rng.uniform(1.2, 2.5) * world.h
        drawn["Geometry"], height = {"Shape": "ball", "Radius": radius}, 2 * radius
    else:
        size = [rng.uniform(2, 5) * world.h for _ in world.cells]
        drawn["Geometry"], height = {"Shape": "box", "Size": size}, size[floor_axis]
    if rng.random() < 0.3:
        drawn["Velocity"] = [rng.uniform(-0.3, 0.3) * world.speed for _ in world.cells]
    if rng.random() < 0.5:
        drawn.update({"Restitution": rng.uniform(0, 1), "Friction": rng.uniform(0, 1)})
    return drawn, height


def lay_down(world, content, seed):
    """Puts bodies into a scene with a liquid."""
    fluid, sides = content["Fluid"], content["Domain"]["Sides"]
    if "Free Surface" not in fluid:
        return
    rng = random.Random(f"lockstep rest {seed}")
    axis = max(range(world.dimension), key=lambda a: abs(fluid["Gravity"][a]))
    up = -math.copysign(1, fluid["Gravity"][axis])
    floor, top = (world.lower[axis], world.upper[axis])[::int(up)]
    for end in ("lower", "upper"):  # a floor and a lid
        if sides[f"{AXES[axis]} {end}"]["Type"] in ("open", "inflow"):
            sides[f"{AXES[axis]} {end}"] = {"Type": "wall"}
    for place in columns(world, axis):
        place[axis] = floor
        for _ in range(rng.randint(1, 3)):
            drawn, height = body(rng, world, axis)
            gap = rng.choice([0.0, 0.0, rng.uniform(0, 0.3) * world.h])
            if not world.names or abs(top - place[axis]) < gap + height + 1.5 * world.h:
                break
            drawn["Position"] = list(place)
            drawn["Position"][axis] += up * (gap + height / 2)
            place[axis] += up * (gap + height)
            content["Solids"][world.new_name()] = drawn
    world.facts.dynamic_rigid = True
