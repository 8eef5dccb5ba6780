"""Seeds from FIRST_SEED on are scenes with a liquid that has a bubble in it, and gas in that bubble and in all other
pockets. They draw from numbers of their own, so that no other seed changes."""
import math
import random

FIRST_SEED = 4000


def around(world, lower, upper, top):
    """Boxes of liquid that leave one between `lower` and `upper` free; `top`: an axis, the direction up along it and a
    height that liquid does not pass, or nothing."""
    far = 2 * max(b - a for a, b in zip(world.lower, world.upper))
    least, most = [a - far for a in world.lower], [b + far for b in world.upper]
    if top:
        axis, up, height = top
        (most if up > 0 else least)[axis] = height
    boxes = {}
    for axis in range(world.dimension):
        below, above = list(most), list(least)
        below[axis], above[axis] = lower[axis], upper[axis]
        boxes[f"Below {axis}"] = {"Type": "box", "Lower": list(least), "Upper": below}
        boxes[f"Above {axis}"] = {"Type": "box", "Lower": above, "Upper": list(most)}
    return boxes


def trap_air(world, content, seed):
    """Changes a scene with a liquid."""
    fluid = content["Fluid"]
    if "Free Surface" not in fluid:
        return
    rng = random.Random(f"lockstep gas {seed}")
    surface, down = fluid["Free Surface"], fluid["Gravity"]
    fluid.pop("Moving Tiles", None)
    middle = [a + rng.uniform(.25, .75) * (b - a) for a, b in zip(world.lower, world.upper)]
    half = [rng.uniform(1.2, 3) * world.h for _ in world.cells]
    lower, upper = [x - r for x, r in zip(middle, half)], [x + r for x, r in zip(middle, half)]
    axis = max(range(world.dimension), key=lambda a: abs(down[a]))
    top = None
    if rng.random() < .7:
        up = -math.copysign(1, down[axis])
        top = axis, up, (upper if up > 0 else lower)[axis] + up * rng.uniform(0, 6) * world.h
    surface["Liquid"] = around(world, lower, upper, top)
    surface["Trapped Air"] = rng.choice(["ideal gas", "ideal gas", "constant volume"])
    weight = world.density * math.hypot(*down) * (world.upper[axis] - world.lower[axis])
    surface["Atmospheric Pressure"] = weight * 10 ** rng.uniform(-1, 2)
    if rng.random() < .3:
        surface["Gas Pressure"] = weight * rng.uniform(-.05, .5)
    if rng.random() < .2:
        surface["Gas Exponent"] = 1.0
