"""Random rigid bodies and rigid thin shells, dynamic, hinged, locked or moved by a script."""
import math

import mesh_files

VOLUMES = {2: ["ball", "box", "cylinder", "capsule", "file"],
           3: ["ball", "box", "cylinder", "capsule", "torus", "file"]}
SHELLS = ["open box", "plate"]
LOCKS = {2: ["x", "y", "rotation"], 3: ["x", "y", "z", "rotation x", "rotation y", "rotation z"]}


def size_within(world, radius):
    """Edges of a box whose corners lie `radius` from its centre; none is shorter than half the longest."""
    edges = [world.rng.uniform(0.5, 1) for _ in range(world.dimension)]
    scale = 2 * radius / math.hypot(*edges)
    return [scale * e for e in edges]


def geometry(world, reach):
    """A shape within `reach` of its origin, and whether it is a thin shell."""
    rng, dim = world.rng, world.dimension
    radius = rng.uniform(0.6, 1) * reach if rng.random() < 0.85 else rng.uniform(0.4, 1.2) * world.h
    shape = rng.choice(VOLUMES[dim] if rng.random() < 0.75 else SHELLS)
    sizes = {"Shape": shape}
    if shape == "ball":
        sizes["Radius"] = radius
    elif shape in ("box", "open box"):
        sizes["Size"] = size_within(world, radius)
    elif shape == "plate":
        sizes.update({"Size": size_within(world, radius), "Normal": rng.choice("xyz"[:dim])})
    elif shape == "cylinder":
        sizes.update({"Radius": 0.6 * radius, "Length": 1.5 * radius})
    elif shape == "capsule":
        sizes.update({"Radius": 0.5 * radius, "Length": radius})
    elif shape == "torus":
        sizes.update({"Radius": 0.65 * radius, "Tube Radius": rng.uniform(0.2, 0.33) * radius})
    else:
        surface = mesh_files.polygon(radius, rng.randint(3, 9)) if dim == 2 else mesh_files.icosahedron(radius)
        kind = rng.choice(["obj", "off"] if dim == 2 else ["obj", "off", "stl"])
        sizes["File"] = world.add_file(kind, getattr(mesh_files, kind)(*surface))
        if rng.random() < 0.3:
            sizes["Scale"] = rng.uniform(0.7, 1)
        if rng.random() < 0.2:
            sizes.update({"Weld": 1e-4 * world.h, "Orient": True})
    is_shell = shape in SHELLS
    if not is_shell and rng.random() < 0.15:
        sizes["Thin Shell"] = is_shell = world.facts.closed_shell = True
    if shape != "file" and rng.random() < 0.2:
        sizes["Mesh Spacing"] = rng.uniform(0.4, 1.5) * world.h
    return sizes, is_shell


def scripted(world, kind, reach):
    """A sinusoid or a table, slower than half the scene's speed."""
    rng, dim = world.rng, world.dimension
    duration = world.n_steps * world.dt
    if kind == "sinusoid":
        frequency = rng.uniform(0.1, 1) / duration
        swing = 0.3 * world.speed / (2 * math.pi * frequency)
        return {"Type": kind, "Amplitude": world.vector(swing), "Frequency": frequency, "Phase": rng.uniform(0, 0.2),
                "Angular Amplitude": world.rotation(0.5 * swing / reach)}
    n = rng.randint(2, 4)
    times = [world.start + duration * k / (n - 1) for k in range(n)]
    path = [x for _ in times for x in world.vector(0.3 * world.speed * duration / n)]
    path[:dim] = [0.0] * dim
    motion = {"Type": kind, "Times": times, "Displacements": path}
    if rng.random() < 0.5:
        motion["Angles"] = [0.0, *(rng.uniform(-0.1, 0.1) for _ in times[1:])]
        if dim == 3:
            motion["Axis"] = world.vector(1.0)
    return motion


def placed_start(world, center, reach):
    """Position and, mostly, a velocity."""
    start = {"Position": center}
    if world.rng.random() < 0.7:
        start["Velocity"] = world.vector(0.5 * world.speed)
    if world.rng.random() < 0.5:
        start["Angular Velocity"] = world.rotation(0.3 * world.speed / reach)
    return start


def locks(world, body):
    """Some motions held; those start from rest."""
    names = LOCKS[world.dimension]
    chosen = world.rng.sample(names, world.rng.randint(1, len(names)))
    n = world.dimension
    for name in chosen:
        k = names.index(name)
        if k < n and "Velocity" in body:
            body["Velocity"][k] = 0.0
        elif k >= n and "Angular Velocity" in body:
            if n == 2:
                body["Angular Velocity"] = 0.0
            else:
                body["Angular Velocity"][k - n] = 0.0
    return chosen


def hinge(world, body, reach):
    """About a point that the body may lie beside; in 3D sometimes about one axis only."""
    n = world.dimension
    body["Pivot"] = world.vector(0.8 * reach)
    body["Locked"] = LOCKS[n][:n]
    body.pop("Velocity", None)
    if n == 3 and world.rng.random() < 0.5:
        body["Locked"] = body["Locked"] + LOCKS[n][n:n + 2]
        if "Angular Velocity" in body:
            body["Angular Velocity"][:2] = [0.0, 0.0]


def turned(world):
    rng = world.rng
    if world.dimension == 2:
        return {"Rotation": rng.uniform(-3, 3)}
    if rng.random() < 0.5:
        axis, angle = world.vector(1.0), rng.uniform(-3, 3)
        return {"Rotation": [angle * x / math.hypot(*axis) for x in axis]}
    w, *v = [rng.gauss(0, 1) for _ in range(4)]  # a quaternion: any rotation is as likely as any other
    angle = 2 * math.atan2(math.hypot(*v), w)
    return {"Rotation": [angle * x / math.hypot(*v) for x in v]}


def rigid_body(world, center, reach):
    rng, dim = world.rng, world.dimension
    shape, is_shell = geometry(world, reach)
    body = {"Type": "rigid body", "Geometry": shape, **placed_start(world, center, reach)}
    ratio = world.density_ratio()
    if rng.random() < 0.25:
        body["Mass"] = ratio * world.density * (2 * world.h) ** dim
    elif is_shell:
        body["Surface Density"] = ratio * world.density * world.h
    else:
        body["Density"] = ratio * world.density
    if rng.random() < 0.5:
        body.update(turned(world))
    if rng.random() < 0.15:
        body["Pivot"] = world.vector(0.3 * reach)
    kind = rng.choice(["constant velocity", "sinusoid", "table"] if world.does_work(0.25) else ["dynamic"] * 8 + ["static"])
    if kind == "dynamic":
        world.facts.dynamic_rigid = True
        if rng.random() < 0.15:
            body["Locked"] = locks(world, body)
        elif rng.random() < 0.1:
            hinge(world, body, reach)
        if world.does_work(0.15):
            pull = world.density * reach ** dim * world.speed / (world.dt * 5)
            body.update({"Force": world.vector(pull), "Torque": world.rotation(pull * reach / 5)})
    else:
        body["Motion"] = {"Type": kind} if kind in ("static", "constant velocity") else scripted(world, kind, reach)
        if kind != "constant velocity":
            body.pop("Velocity", None)
            body.pop("Angular Velocity", None)
    return body
