"""Seeds from FIRST_SEED on are scenes with a free surface, and often with moving tiles: those of the other seeds,
with a liquid in place of the fluid. They draw from numbers of their own, so that no other seed changes. From
FIRST_OF_FRACTIONS on the liquid is carried as volumes."""
import math
import random

AXES = "xyz"
FIRST_SEED = 1000
FIRST_OF_FRACTIONS = 2000
OF_GASES = ("Smoke", "Temperature", "Smoke Weight", "Thermal Expansion", "Sources")


def is_periodic(sides, axis):
    return sides[f"{AXES[axis]} lower"]["Type"] == "periodic"


def pushed_along_periodic_axis(fluid, sides):
    """Moving tiles take the fluid far away to be at rest."""
    return any(force != 0 and is_periodic(sides, axis) for axis, force in enumerate(fluid.get("Body Force", ())))


def point(rng, world, least=0.0, most=1.0):
    return [a + rng.uniform(least, most) * (b - a) for a, b in zip(world.lower, world.upper)]


def gravity(rng, world, axes):
    """Mostly straight down an axis; never along a periodic one."""
    size = world.speed / world.dt / 5 * rng.uniform(0.2, 1)
    down = rng.choice(axes)
    tilt = rng.choice([0.0, 0.0, 0.3])
    vector = [0.0] * world.dimension
    for axis in axes:
        vector[axis] = size * (rng.choice([-1, 1]) if axis == down else rng.uniform(-tilt, tilt))
    return vector


def liquid(rng, world, down):
    """A pool between a fifth and four fifths of the domain, often with more above."""
    size = math.hypot(*down)
    up = [-g / size for g in down]
    surface = point(rng, world, 0.2, 0.8)
    parts = {"Pool": {"Type": "level", "Height": sum(u * x for u, x in zip(up, surface))}}
    if rng.random() < 0.3:
        amplitude, wavelength = rng.uniform(0, 1) * world.h, rng.uniform(6, 20) * world.h
        parts["Pool"]["Height"] = f"{parts['Pool']['Height']} + {amplitude}*cos(2*_pi/{wavelength}*x)"
    if rng.random() < 0.4:
        parts["Drop"] = {"Type": "ball", "Center": point(rng, world), "Radius": rng.uniform(1, 4) * world.h}
    if rng.random() < 0.2:
        middle = point(rng, world)
        parts["Block"] = {"Type": "box", "Lower": [x - rng.uniform(1, 4) * world.h for x in middle],
                          "Upper": [x + rng.uniform(1, 4) * world.h for x in middle]}
    return parts


def fill_with_liquid(world, content, seed):
    """Changes the list "Fluid"; not where gravity has no axis to act along."""
    rng = random.Random(f"lockstep liquid {seed}")
    fluid, sides = content["Fluid"], content["Domain"]["Sides"]
    axes = [axis for axis in range(world.dimension) if not is_periodic(sides, axis)]
    if not axes:
        return
    for name in OF_GASES:
        fluid.pop(name, None)
        for side in sides.values():
            side.pop(name, None)
    fluid["Order in Time"] = 1
    fluid["Gravity"] = gravity(rng, world, axes)
    surface = fluid["Free Surface"] = {"Interface": {"Type": rng.choice(["level set", "particle level set"])},
                                       "Liquid": liquid(rng, world, fluid["Gravity"])}
    if FIRST_OF_FRACTIONS <= seed < FIRST_SEED + 2000:
        surface["Interface"]["Type"] = "volume of fluid"
    if rng.random() < 0.2 and seed < FIRST_OF_FRACTIONS:
        surface["Interface"]["Volume Correction"] = rng.choice(["global", "none"])
    if rng.random() < 0.1:
        surface["Pressure Order"] = 1
    if rng.random() < 0.2:
        surface["Surface Tension"] = world.density * world.h ** 3 / world.dt ** 2 * 10 ** rng.uniform(-3, -1)
    if rng.random() < 0.4 and not pushed_along_periodic_axis(fluid, sides):
        fluid["Moving Tiles"] = {"Tile Margin": 16}
    world.facts.liquid = world.facts.works = True
    world.facts.scalar_range.clear()
