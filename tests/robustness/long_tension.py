"""Seeds from FIRST_SEED on are scenes with a liquid whose surface tension acts in steps up to eight times the explicit
bound, semi-implicitly, mostly with drops that fly, and in a third of them with gas in a bubble. They draw from numbers
of their own, so that no other seed changes."""
import random

import gases

FIRST_SEED = 5000
EXPLICIT = .28  # steps are at most so many sqrt(density h^3 / tension), docs/parameters
LONGEST = 8  # times as long


def lengthen(world, content, seed):
    """Changes a scene with a liquid."""
    fluid = content["Fluid"]
    if "Free Surface" not in fluid:
        return
    rng = random.Random(f"lockstep tension {seed}")
    if rng.random() < .33:
        gases.trap_air(world, content, seed)
    surface = fluid["Free Surface"]
    surface["Interface"] = {"Type": rng.choice(["level set", "particle level set", "particle level set", "volume of fluid"])}
    if surface["Interface"]["Type"] == "particle level set" and "Trapped Air" not in surface and rng.random() < .7:
        surface["Interface"]["Drops"] = "ballistic"
    times = rng.uniform(.5, .95 * LONGEST)
    surface["Surface Tension"] = world.density * world.h ** 3 * (times * EXPLICIT / world.dt) ** 2
    surface["Time Integration"] = "semi-implicit"
