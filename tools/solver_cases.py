"""Scenes that the tools measure solvers on, the bandwidth of this machine, and where things are."""
import json
import pathlib
import random
import re
import subprocess

from stale_pages import commit_of_tree

ROOT = pathlib.Path(__file__).resolve().parent.parent


def parameter(name, kind, value):
    return f'<Parameter name="{name}" type="{kind}" value="{value}"/>'


def vector(values):
    return "{" + ", ".join(f"{value:.6g}" for value in values) + "}"


def body(name, geometry, position, density=None, surface_density=None):
    lines = [f'<ParameterList name="{name}">', parameter("Type", "string", "rigid body"),
             '<ParameterList name="Geometry">', *geometry, "</ParameterList>",
             parameter("Position", "Array(double)", vector(position))]
    if density is not None:
        lines.append(parameter("Density", "double", repr(float(density))))
    if surface_density is not None:
        lines.append(parameter("Surface Density", "double", repr(float(surface_density))))
    return lines + ["</ParameterList>"]


def ball(name, radius, position, density):
    return body(name, [parameter("Shape", "string", "ball"), parameter("Radius", "double", radius)], position, density)


def thirty_balls(density):
    """At the points of a lattice, each moved a little, so that they do not touch and no two are alike."""
    generator = random.Random(3)
    points = [(0.15 + 0.175 * i, 0.14 + 0.18 * j, 0.15 + 0.175 * k)
              for i in range(5) for j in range(3) for k in range(5)]
    lines = []
    for number, point in enumerate(generator.sample(points, 30)):
        position = [x + generator.uniform(-0.012, 0.012) for x in point]
        lines += ball(f"Ball {number + 1:02d}", 0.065, position, density)
    return lines


def row_of_balls(density):
    """Five that touch nearly, in a row aslant, of densities about that one, and the joints that tie each to the next."""
    places = [(0.16 + 0.17 * i, 0.35 + 0.07 * i, 0.5 + 0.03 * (-1) ** i) for i in range(5)]
    solids, joints = [], ['<ParameterList name="Joints">']
    for i, (place, factor) in enumerate(zip(places, (1, 3, 0.5, 2, 1))):
        solids += ball(f"Ball {i + 1}", 0.08, place, density * factor)
    for i, (place, following) in enumerate(zip(places, places[1:])):
        joints += [f'<ParameterList name="Joint {i + 1}">', parameter("Type", "string", "ball"),
                   parameter("Solids", "Array(string)", f"{{Ball {i + 1}, Ball {i + 2}}}"),
                   parameter("Point", "Array(double)", vector([(a + b) / 2 for a, b in zip(place, following)])),
                   "</ParameterList>"]
    return solids, joints + ["</ParameterList>"]


def pool(level, amplitude):
    """Lists for the list `Fluid`: water up to about that height, with a standing wave, and air above."""
    return ['<ParameterList name="Free Surface"><ParameterList name="Liquid"><ParameterList name="Pool">',
            parameter("Type", "string", "level"), parameter("Height", "double", f"[{level} + {amplitude}*cos(_pi*x)]"), "</ParameterList></ParameterList></ParameterList>"]


def scene_of(is_open, solids, cells, step=0.005, fluid=(), joints=()):
    """The text of a scene file: a unit cube of water, gravity, n^3 cells; `fluid` adds to the list of that name, `joints`
    is one. Without a step it is as long as CFL lets it be."""
    lines = ['<ParameterList name="Scene">', parameter("Dimension", "int", 3), '<ParameterList name="Domain">',
             parameter("Upper", "Array(double)", "{1, 1, 1}"),
             parameter("Cells", "Array(int)", "{" + ", ".join([str(cells)] * 3) + "}")]
    if is_open:
        lines += ['<ParameterList name="Sides"><ParameterList name="y upper">', parameter("Type", "string", "open"),
                  "</ParameterList></ParameterList>"]
    lines += ["</ParameterList>", '<ParameterList name="Fluid">', parameter("Type", "string", "mac"),
              parameter("Density", "double", "1000.0"), parameter("Gravity", "Array(double)", "{0, -9.8, 0}"),
              *fluid, "</ParameterList>", '<ParameterList name="Solids">', *solids, "</ParameterList>", *joints,
              '<ParameterList name="Time">', parameter("End", "double", "1.0"),
              *([parameter("Fixed Step", "double", repr(step))] if step else []), "</ParameterList>", '<ParameterList name="Output">',
              parameter("Frames", "bool", "false"), "</ParameterList>", "</ParameterList>"]
    return "\n".join(lines) + "\n"


PLATE = body("Plate", [parameter("Shape", "string", "plate"), parameter("Size", "Array(double)", "{0.62, 0, 0.58}"),
                       parameter("Normal", "string", "y")], (0.47, 0.43, 0.52), surface_density=20)
CASES = {
    "free top, ball 1e-3": (True, ball("Ball", 0.15, (0.47, 0.41, 0.53), 1)),
    "free top, ball 1": (True, ball("Ball", 0.15, (0.47, 0.41, 0.53), 1000)),
    "free top, ball 1e3": (True, ball("Ball", 0.15, (0.47, 0.41, 0.53), 1e6)),
    "closed, ball 0.5": (False, ball("Ball", 0.15, (0.47, 0.41, 0.53), 500)),
    "free top, 30 balls 2": (True, thirty_balls(2000)),
    "free top, 30 balls 1e-3": (True, thirty_balls(1)),
    "free top, thin plate": (True, PLATE),
    "in waves, ball 0.5": (True, ball("Ball", 0.15, (0.47, 0.52, 0.53), 500), pool(0.5, 0.04)),
    "in waves, ball 1e-3": (True, ball("Ball", 0.15, (0.47, 0.52, 0.53), 1), pool(0.5, 0.04)),
}


def scene(case, cells):
    """`CASES`: whether the tank is open above, its solids and, of some, what is in the list of the fluid."""
    is_open, solids, *fluid = CASES[case]
    return scene_of(is_open, solids, cells, fluid=fluid[0] if fluid else ())


def largest_cache_megabytes():
    text = subprocess.run(["lscpu", "-B", "-C=NAME,ONE-SIZE", "--json"], capture_output=True, text=True).stdout
    sizes = [int(cache["one-size"]) for cache in json.loads(text)["caches"]] if text else []
    return max(sizes, default=32 << 20) / 1e6  # some virtual machines show none


def triad(build, n_cores=1):
    """Bytes a second of STREAM's triad [GB/s], of so many cores at a time together; the best of three."""
    command = [build / "tests/benchmarks/triad", str(int(4 * largest_cache_megabytes()))]

    def once():
        running = [subprocess.Popen(command, stdout=subprocess.PIPE, text=True) for _ in range(n_cores)]
        return sum(float(re.search(r"[0-9.]+", process.communicate()[0]).group()) for process in running)
    return max(once() for _ in range(3))


# Asked for before anything is measured: somebody may commit while a tool runs.
COMMIT = commit_of_tree()
