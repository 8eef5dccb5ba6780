"""A scene and its image: the same with its axes turned. Nothing in physics tells them apart, and no code is shared by
what an axis is called; what is read along x in one run is read along y in the other."""
import copy
import math

DIRECTIONS = {"Velocity", "Gravity", "Body Force", "Force", "Amplitude", "Offset", "Axis", "Second Axis"}
AXIAL = {"Angular Velocity", "Torque", "Angular Amplitude"}  # turn as directions do, numbers in 2D
IN_SPACE = {"Center", "Position", "Point"}
BOXES_OF_BODIES = {"Pin", "Pull", "Spring", "Root"}  # in the body's own coordinates
NOT_TURNED = ('"Velocity" type="Array(string)"', "cos(2*_pi/", '"linear"', "particle level set", "volume of fluid", "Vortices", "Wavelength", "Trapped Air")
QUARTER = math.pi / 2


def turn(v):
    """(x, y) to (-y, x); (x, y, z) to (z, x, y): a third of a turn about the diagonal."""
    return [-v[1], v[0]] if len(v) == 2 else [v[2], v[0], v[1]]


def turn_back(v):
    return [v[1], -v[0]] if len(v) == 2 else [v[1], v[2], v[0]]


def turn_axis(name, dimension):
    return {"x": "y", "y": "x" if dimension == 2 else "z", "z": "x"}[name]


def turn_axes(names, dimension):
    """Turns the axes at the end of names, as in "rotation x"; "rotation" alone is that of 2D."""
    return [name if name == "rotation" else name[:-1] + turn_axis(name[-1], dimension) for name in names]


def turn_box(lower, upper):
    ends = [sorted(pair) for pair in zip(turn(lower), turn(upper))]
    return [a for a, _ in ends], [b for _, b in ends]


def turn_side(name, dimension):
    axis, end = name.split()
    if dimension == 2 and axis == "y":
        end = {"lower": "upper", "upper": "lower"}[end]
    return f"{turn_axis(axis, dimension)} {end}"


def quaternion(axis, angle):
    length = math.hypot(*axis)
    return [math.cos(angle / 2), *(math.sin(angle / 2) * x / length for x in axis)]


def product(a, b):
    (s, *u), (t, *v) = a, b
    cross = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
    return [s * t - sum(x * y for x, y in zip(u, v)), *(s * y + t * x + c for x, y, c in zip(u, v, cross))]


THIRD = quaternion([1, 1, 1], 2 * math.pi / 3)


def turn_body(body, dimension):
    if dimension == 2:
        body["Rotation"] = body.get("Rotation", 0.0) + QUARTER
        return
    rotation = body.get("Rotation", [0.0, 0.0, 0.0])
    angle = math.hypot(*rotation)
    w, *v = product(THIRD, quaternion(rotation, angle) if angle else [1.0, 0.0, 0.0, 0.0])
    sine = math.hypot(*v)
    body["Rotation"] = [2 * math.atan2(sine, w) * x / sine for x in v]


def turn_list(content, name, dimension):
    """Turns the vectors of space in a list, by the names of its parameters."""
    for key, value in content.items():
        if isinstance(value, dict):
            turn_list(value, key, dimension)
        elif key == "Locked":
            content[key] = turn_axes(value, dimension)
        elif key == "Displacements":
            content[key] = [x for i in range(0, len(value), dimension) for x in turn(value[i:i + dimension])]
        elif isinstance(value, list) and key in DIRECTIONS | IN_SPACE or isinstance(value, list) and key in AXIAL and dimension == 3:
            content[key] = turn(value)
    if "Lower" in content and "Upper" in content and name not in BOXES_OF_BODIES:
        content["Lower"], content["Upper"] = turn_box(content["Lower"], content["Upper"])


def has_rotated_copy(scene):
    """Not where directions or numbers of cells are built in (gas has its pressure of a volume of triangles), not where contact decides by inequalities, and not where a
    solid may stick through a periodic side: not all are repeated at the other."""
    return (not any(word in scene.xml for word in NOT_TURNED) and scene.content["Contact"]["Type"] == "none" and
            not (scene.facts.periodic and scene.content["Solids"]))


def rotated_copy(content):
    """The content of a scene, turned; observers are left out."""
    content = copy.deepcopy(content)
    dimension = content["Dimension"]
    content.pop("Observers", None)
    turn_list(content, "Scene", dimension)
    domain = content["Domain"]
    domain["Cells"] = [abs(n) for n in turn(domain["Cells"])]
    domain["Sides"] = {turn_side(name, dimension): side for name, side in domain["Sides"].items()}
    for body in content["Solids"].values():
        turn_body(body, dimension)
    return content


def turned_back(tables):
    """With the bodies' vectors as in the scene itself."""
    tables = copy.copy(tables)
    tables.bodies = [dict(row) for row in tables.bodies]
    for row in tables.bodies:
        for prefix in ("", "v", "w"):
            names = [prefix + axis for axis in "xyz" if prefix + axis in row]
            if len(names) > 1:
                row.update(zip(names, map(str, turn_back([float(row[name]) for name in names]))))
    return tables
