"""Seeds from FIRST_SEED on are scenes with a liquid below a gas that has a mass, of a third to a three thousandth of the liquid's
density (at 1e-6 round-off leaves residuals of 1e-10, at which these scenes are solved). They draw from numbers of their own, so that no other seed changes."""
import random

FIRST_SEED = 9000


def give_air_mass(world, content, seed):
    """Changes a scene with a liquid."""
    fluid = content["Fluid"]
    if "Free Surface" not in fluid:
        return
    rng = random.Random(f"lockstep phases {seed}")
    fluid.pop("Moving Tiles", None)
    viscosity = fluid.get("Viscosity", 0.0)
    surface = fluid["Free Surface"]
    surface.pop("Pressure Order", None)
    phases = fluid["Phases"] = {"Gas": {"Density": world.density * 10 ** rng.uniform(-3.5, -.5), "Viscosity": viscosity * 10 ** rng.uniform(-3, 0)}}
    if rng.random() < .15:
        phases["Interface Transport"] = "plain"
    if rng.random() < .3:
        surface["Interface"] = {"Type": "volume of fluid"}
    if rng.random() < .4:
        surface["Bubbles"] = {"Bubble": {"Type": "ball", "Center": [a + rng.uniform(.1, .9) * (b - a) for a, b in zip(world.lower, world.upper)],
                                         "Radius": rng.uniform(.5, 4) * world.h}}
