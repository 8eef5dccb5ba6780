"""Random deformable bodies and cloth: shapes, materials, integrations and all that may hold them."""
import mesh_files
from rigid_solids import placed_start, scripted, size_within

VOLUMES = {2: ["ball", "box", "cylinder", "hollow ball", "file"],
           3: ["ball", "box", "cylinder", "torus", "hollow ball", "tube", "file"]}
SHELLS = ["sheet", "bag", "ball", "open ball", "tube", "file"]
MATERIALS = ["corotated", "neo-hookean", "st venant-kirchhoff", "linear"]
INTEGRATIONS = ["explicit", "semi-implicit", "fully-implicit", "second-order"]


def volume_geometry(world, reach):
    """A shape within `reach` of its origin. Walls of hollow ones are more than a cell thick."""
    rng, dim = world.rng, world.dimension
    radius = rng.uniform(0.75, 1) * reach
    shape = rng.choice(VOLUMES[dim])
    sizes = {"Shape": shape, "Mesh Spacing": rng.uniform(0.7, 1.6) * world.h}
    if shape == "ball":
        sizes["Radius"] = radius
    elif shape == "box":
        sizes["Size"] = size_within(world, radius)
    elif shape == "cylinder":
        sizes.update({"Radius": 0.55 * radius, "Length": 1.5 * radius})
    elif shape == "torus":
        sizes.update({"Radius": 0.65 * radius, "Tube Radius": 0.33 * radius})
    elif shape == "hollow ball":
        sizes.update({"Radius": radius, "Thickness": rng.uniform(0.4, 0.6) * radius})
    elif shape == "tube":
        sizes.update({"Radius": 0.7 * radius, "Thickness": 0.4 * radius, "Length": 1.2 * radius})
    else:
        surface = mesh_files.polygon(radius, rng.randint(5, 9)) if dim == 2 else mesh_files.icosahedron(radius)
        kind = rng.choice(["msh", "vtk"])
        write = mesh_files.gmsh if kind == "msh" else mesh_files.vtk
        del sizes["Mesh Spacing"]
        sizes["File"] = world.add_file(kind, write(*mesh_files.filled(*surface), dim))
        if rng.random() < 0.3:
            sizes["Scale"] = rng.uniform(0.8, 1)
        if rng.random() < 0.2:
            sizes.update({"Weld": 1e-4 * world.h, "Orient": True})
    return sizes


def shell_geometry(world, reach):
    rng, dim = world.rng, world.dimension
    radius = rng.uniform(0.75, 1) * reach
    shape = rng.choice(SHELLS)
    sizes = {"Shape": shape, "Mesh Spacing": rng.uniform(0.8, 1.5) * world.h}
    if shape == "sheet":
        sizes.update({"Size": size_within(world, radius), "Normal": rng.choice("xyz"[:dim])})
    elif shape == "bag":
        sizes["Size"] = size_within(world, radius)
    elif shape == "ball":
        sizes["Radius"] = radius
    elif shape == "open ball":
        sizes.update({"Radius": radius, "Opening Radius": rng.uniform(0.4, 0.7) * radius})
    elif shape == "tube":
        sizes.update({"Radius": 0.6 * radius, "Length": 1.5 * radius})
    else:
        del sizes["Mesh Spacing"]
        surface = mesh_files.polygon(radius, rng.randint(6, 12)) if dim == 2 else mesh_files.icosahedron(radius)
        kind = rng.choice(["obj", "off"] if dim == 2 else ["obj", "off", "stl"])
        sizes["File"] = world.add_file(kind, getattr(mesh_files, kind)(*surface))
    if shape in ("ball", "file"):
        world.facts.closed_shell = True
    return sizes


def half_space(world, geometry, reach, part):
    """A region that holds the nodes below `part` times -reach along an axis; part <= 0.2 meets every shape."""
    axes = [a for a in range(world.dimension) if "xyz"[a] != geometry.get("Normal")]
    axis = world.rng.choice(axes)
    upper = [2 * reach] * world.dimension
    upper[axis] = -part * reach
    return {"Lower": [-2 * reach] * world.dimension, "Upper": upper}


def pinned(world, geometry, reach):
    rng = world.rng
    region = half_space(world, geometry, reach, rng.uniform(0.05, 0.2))
    if rng.random() < 0.3:
        region["Locked"] = rng.sample(list("xyz"[:world.dimension]), rng.randint(1, world.dimension))
    kind = rng.choice(["constant velocity", "sinusoid", "table"]) if world.does_work(0.6) else "static"
    if kind == "constant velocity":
        region["Motion"] = {"Type": kind, "Velocity": world.vector(0.3 * world.speed),
                            "Angular Velocity": world.rotation(0.2 * world.speed / reach)}
    elif kind != "static":
        region["Motion"] = scripted(world, kind, reach)
    if rng.random() < 0.4:
        region["End"] = world.start + rng.uniform(0, world.n_steps) * world.dt
    return {"Pin": region}


def held(world, geometry, reach):
    """Constraints and loads of a soft body whose origin lies inside it."""
    rng, lists = world.rng, {}
    if rng.random() < 0.3:
        lists["Pinned"] = pinned(world, geometry, reach)
    force = world.density * reach ** world.dimension * world.speed / (world.dt * 10)
    if world.does_work(0.12):
        lists["Loads"] = {"Pull": {**half_space(world, geometry, reach, 0.1), "Force": world.vector(force)}}
    if rng.random() < 0.12:
        lists["Tethers"] = {"Spring": {**half_space(world, geometry, reach, 0.1), "Stiffness": force / world.h,
                                       "Offset": world.vector(0.2 * world.h)}}
        world.facts.springs = True
    return lists


def integration(world):
    rng = world.rng
    kind = rng.choice(INTEGRATIONS)
    chosen = {"Time Integration": kind}
    if kind in ("explicit", "semi-implicit"):
        world.facts.explicit = True
        if rng.random() < 0.5:
            chosen["Most Sub-Steps"] = rng.choice([2, 10, 40])
            world.facts.sub_steps = True
    if rng.random() < 0.25:
        chosen["Mass"] = "consistent"
    if rng.random() < 0.25:
        chosen["Stiffness Damping"] = 10 ** rng.uniform(-3, 0) * world.dt
    return chosen


def soft_start(world, center, reach, turn):
    """Position and motion, with turns of at most `turn` radians."""
    start = placed_start(world, center, reach)
    if world.rng.random() < 0.4:
        start["Rotation"] = world.rotation(turn)
    if world.rng.random() < 0.25:
        start["Stretch"] = [world.rng.uniform(0.92, 1.08) for _ in range(world.dimension)]
    if world.rng.random() < 0.1:
        start["Vortices"] = {"Amplitude": 0.2 * world.speed, "Wavelength": 4 * reach}
    return start


def stiffness(world, density):
    """Young's modulus by the cells that a wave of the material crosses in a step."""
    return density * (world.h / world.dt) ** 2 * 10 ** world.rng.uniform(-2, 2.5)


def deformable_body(world, center, reach, geometry=None):
    rng = world.rng
    density = world.density_ratio() * world.density
    law, geometry = rng.choice(MATERIALS), geometry or volume_geometry(world, reach)
    body = {"Type": "deformable body", "Geometry": geometry,
            "Material": {"Type": law, "Young's Modulus": stiffness(world, density),
                         "Poisson's Ratio": rng.choice([0.0, 0.3, 0.3, 0.45, -0.2])},
            "Density": density, **integration(world),
            **soft_start(world, center, reach, 0.05 if law == "linear" else 3.0), **held(world, geometry, reach)}
    world.facts.crushed |= law == "st venant-kirchhoff" and "Most Sub-Steps" in body
    if rng.random() < 0.3:
        body["Viscosity"] = density * world.h ** 2 / world.dt * 10 ** rng.uniform(-3, 0)
    world.facts.soft = True
    return body


def cloth(world, center, reach, geometry=None):
    rng = world.rng
    surface_density = world.density_ratio() * world.density * world.h
    thickness, geometry = 10 ** rng.uniform(-2, -0.7) * world.h, geometry or shell_geometry(world, reach)
    body = {"Type": "cloth", "Geometry": geometry,
            "Young's Modulus": stiffness(world, surface_density / thickness), "Thickness": thickness,
            "Surface Density": surface_density, "Poisson's Ratio": rng.choice([0.0, 0.3, 0.45]),
            "Bending": rng.choice(["as meshed", "flat", "none"]), **integration(world),
            **soft_start(world, center, reach, 3.0), **held(world, geometry, reach)}
    if rng.random() < 0.3:
        body["Membrane"] = {"Type": "mass-spring"}
        rng.uniform(0, 1)  # drawn once for a parameter that is no more: seeds keep their scenes
    else:
        world.facts.crushed |= "Most Sub-Steps" in body  # the membrane is of St. Venant-Kirchhoff's law
    if rng.random() < 0.25:
        body["Pre-Strain"] = rng.uniform(-0.05, 0.1)
    if rng.random() < 0.2:
        body["Surface Tension"] = surface_density * world.h ** 2 / world.dt ** 2 * 10 ** rng.uniform(-3, -1)
    if rng.random() < 0.2:
        body["Stretch Limit"] = rng.uniform(0.12, 0.3)
    if body["Time Integration"] == "fully-implicit" and rng.random() < 0.1:
        body["Surface Density"] = 0.0  # the fluid lumped on it is all its mass
        body.pop("Stretch Limit", None)  # shares what it does by mass
        world.facts.massless = True
    world.facts.soft = True
    return body


def carried(world, center, reach):
    """A dynamic rigid ball and what it carries: a tail, or a sheet."""
    rng, dim = world.rng, world.dimension
    ball, radius = world.new_name(), 0.4 * reach
    left = [center[0] - 0.5 * reach, *center[1:]]
    solids = {ball: {"Type": "rigid body", "Geometry": {"Shape": "ball", "Radius": radius},
                     "Density": world.density_ratio() * world.density, "Position": left}}
    length = 1.0 * reach
    size = [length] + [max(0.3 * reach, 1.2 * world.h)] * (dim - 1)
    box = {"Shape": "box", "Size": size, "Mesh Spacing": world.h}
    sheet = {"Shape": "sheet", "Size": size, "Normal": "y", "Mesh Spacing": world.h}
    make, geometry = rng.choice([(deformable_body, box), (cloth, sheet)])
    soft = make(world, center, 0.4 * reach, geometry)
    for given in ("Pinned", "Rotation", "Stretch", "Velocity", "Angular Velocity", "Vortices", "Pre-Strain"):
        soft.pop(given, None)
    soft["Position"] = [left[0] + radius + 0.4 * length, *center[1:]]
    soft["Attachments"] = {"Root": {"Lower": [-length, *[-2 * reach] * (dim - 1)],
                                    "Upper": [-0.3 * length, *[2 * reach] * (dim - 1)], "Solid": ball}}
    solids[world.new_name()] = soft
    world.facts.attached = world.facts.dynamic_rigid = True
    return solids
