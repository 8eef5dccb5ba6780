"""Robots described in URDF: links with masses and shapes, and joints between them, placed in space with all joints at zero."""
import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass, field
from pathlib import Path

import numpy

JOINT_TYPES = ("revolute", "continuous", "prismatic", "fixed", "floating", "planar")
OUTSIDE = {"material", "gazebo", "transmission", "link", "joint"}  # elements of a robot that are read, or have no meaning for its motion


class RobotError(Exception):
    """An error in a robot: what is wrong, where, and what to do."""


@dataclass
class Shape:
    kind: str  # box, sphere, cylinder, mesh
    place: numpy.ndarray  # 4 x 4, in the link
    numbers: tuple = ()  # edges; radius; radius and length; scale
    file: str = ""


@dataclass
class Link:
    name: str
    mass: float = 0
    centre: numpy.ndarray = None  # 4 x 4: of mass, with the axes of the inertia
    inertia: numpy.ndarray = None  # 3 x 3
    shapes: list = field(default_factory=list)
    place: numpy.ndarray = None  # 4 x 4, in space


@dataclass
class Joint:
    name: str
    kind: str
    parent: str
    child: str
    place: numpy.ndarray  # 4 x 4, in the parent
    axis: numpy.ndarray
    limits: tuple = ()
    damping: float = 0
    has_actuator_limits: bool = False  # limits of effort or velocity


def required(element, name, where):
    """An attribute that has to be there."""
    value = element.get(name) if element is not None else None
    if not value:
        raise RobotError(f'{where} lacks "{name}".')
    return value


def by_name(things, kind, file):
    result = {}
    for thing in things:
        if thing.name in result:
            raise RobotError(f'{file}: two {kind} are called "{thing.name}".')
        result[thing.name] = thing
    return result


def numbers(text, n, where):
    try:
        values = [float(word) for word in (text or "").split()]
    except ValueError:
        values = []
    if len(values) != n or not numpy.isfinite(values).all():
        raise RobotError(f'{where} is "{text}"; it takes {n} number{"s" if n > 1 else ""}.')
    return values


def sizes(text, n, where):
    values = numbers(text, n, where)
    if min(values) <= 0:
        raise RobotError(f'{where} is "{text}"; sizes are greater than 0.')
    return values


def pose(element, where):
    """Pose of the element's <origin>: turned by roll, pitch and yaw about the axes of space, then shifted."""
    origin = element.find("origin")
    result = numpy.eye(4)
    if origin is None:
        return result
    roll, pitch, yaw = numbers(origin.get("rpy", "0 0 0"), 3, f"{where}: rpy of the origin")
    for axis, angle in ((0, roll), (1, pitch), (2, yaw)):
        i, j = (axis + 1) % 3, (axis + 2) % 3
        turn = numpy.eye(4)
        turn[i, i] = turn[j, j] = numpy.cos(angle)
        turn[j, i], turn[i, j] = numpy.sin(angle), -numpy.sin(angle)
        result = turn @ result
    result[:3, 3] = numbers(origin.get("xyz", "0 0 0"), 3, f"{where}: xyz of the origin")
    return result


def mesh_file(name, robot_file, packages):
    """`package://NAME/PATH` is looked for in the folder given for NAME, or above the robot's file."""
    scheme = "package://"
    if not name.startswith(scheme):
        file = robot_file.parent / name.removeprefix("file://")
        if not file.exists():
            raise RobotError(f"{robot_file}: there is no file {file}.")
        return file
    package, _, rest = name.removeprefix(scheme).partition("/")
    if package in packages:
        return Path(packages[package]) / rest
    for folder in robot_file.resolve().parents:
        for candidate in (folder / rest, folder / package / rest):
            if candidate.exists():
                return candidate
    raise RobotError(f'{robot_file}: "{name}" is not found; say where that package is with --package {package}=FOLDER.')


def read_shape(element, where, robot_file, packages):
    geometry = element.find("geometry")
    if geometry is None or not len(geometry):
        raise RobotError(f"{where} has no geometry.")
    shape, place = geometry[0], pose(element, where)
    if shape.tag == "box":
        return Shape("box", place, tuple(sizes(shape.get("size"), 3, f"{where}: size")))
    if shape.tag == "sphere":
        return Shape("sphere", place, tuple(sizes(shape.get("radius"), 1, f"{where}: radius")))
    if shape.tag == "cylinder":
        return Shape("cylinder", place, (*sizes(shape.get("radius"), 1, f"{where}: radius"),
                                         *sizes(shape.get("length"), 1, f"{where}: length")))
    if shape.tag != "mesh":
        raise RobotError(f"{where}: the shape <{shape.tag}> is not known; box, sphere, cylinder and mesh are.")
    name = shape.get("filename", "")
    if not name.lower().endswith((".stl", ".obj")):
        raise RobotError(f'{where}: the mesh "{name}" is no STL or OBJ file; convert it.')
    scale = numbers(shape.get("scale", "1 1 1"), 3, f"{where}: scale")
    if len(set(scale)) > 1 or scale[0] <= 0:
        raise RobotError(f"{where}: the mesh is scaled by {scale}; it takes one factor for all axes.")
    return Shape("mesh", place, (scale[0],), str(mesh_file(name, robot_file, packages)))


def read_link(element, which_shapes, robot_file, packages):
    link = Link(required(element, "name", f"{robot_file}: a link"))
    where = f'{robot_file}: the link "{link.name}"'
    inertial = element.find("inertial")
    if inertial is not None and inertial.find("mass") is not None:
        link.mass, = numbers(inertial.find("mass").get("value"), 1, f"{where}: mass")
        link.centre = pose(inertial, where)
        tensor = inertial.find("inertia")
        if tensor is None:
            raise RobotError(f"{where} has a mass without an inertia.")
        xx, xy, xz, yy, yz, zz = (numbers(tensor.get(name, "0"), 1, f"{where}: {name}")[0]
                                  for name in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz"))
        link.inertia = numpy.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
        if link.mass < 0:
            raise RobotError(f"{where} has a mass of {link.mass:g} kg; give it one from 0 on.")
        moments = numpy.linalg.eigvalsh(link.inertia)
        if link.mass > 0 and (moments[0] < -1e-9 * abs(moments).max() or moments[2] <= 0):
            raise RobotError(f"{where} has a mass and the moments of inertia {moments.tolist()}, which no body has; correct "
                             "its <inertia>.")
    link.shapes = [read_shape(shape, where, robot_file, packages) for shape in element.findall(which_shapes)]
    return link


def read_joint(element, robot_file):
    name = required(element, "name", f"{robot_file}: a joint")
    where, kind = f'{robot_file}: the joint "{name}"', element.get("type")
    if kind not in JOINT_TYPES:
        raise RobotError(f'{where} has the type "{kind}"; {", ".join(JOINT_TYPES)} are known.')
    for refused in ("mimic", "safety_controller"):
        if element.find(refused) is not None:
            raise RobotError(f"{where} has <{refused}>, which cannot be had here; take it out of the file.")
    axis = element.find("axis")
    axis = numpy.array(numbers(axis.get("xyz", "1 0 0"), 3, f"{where}: axis") if axis is not None else (1., 0., 0.))
    if not axis.any():
        raise RobotError(f"{where} has an axis of no length.")
    parent, child = (required(element.find(side), "link", f"{where}: its <{side}>") for side in ("parent", "child"))
    joint = Joint(name, kind, parent, child, pose(element, where), axis / numpy.linalg.norm(axis))
    limit, dynamics = element.find("limit"), element.find("dynamics")
    if limit is not None:
        joint.has_actuator_limits = any(numbers(limit.get(name, "0"), 1, f"{where}: {name}")[0] > 0
                                        for name in ("effort", "velocity"))
        if kind in ("revolute", "prismatic"):
            joint.limits = tuple(numbers(limit.get(name, "0"), 1, f"{where}: {name}")[0] for name in ("lower", "upper"))
            if not joint.limits[0] <= 0 <= joint.limits[1]:
                raise RobotError(f"{where} has limits {joint.limits} that leave out 0, where a scene begins.")
    elif kind in ("revolute", "prismatic"):
        raise RobotError(f"{where} has no <limit>, which its type needs.")
    if dynamics is not None:
        joint.damping, = numbers(dynamics.get("damping", "0"), 1, f"{where}: damping")
        if numbers(dynamics.get("friction", "0"), 1, f"{where}: friction")[0] != 0:
            raise RobotError(f"{where} has friction, which cannot be had here; set it to 0, or give it damping.")
    return joint


def place_links(links, joints, base):
    """Fills in where links are; the links no joint carries stand at `base`."""
    below = {}
    for joint in joints.values():
        for side in (joint.parent, joint.child):
            if side not in links:
                raise RobotError(f'The joint "{joint.name}" names the link "{side}", but there is none.')
        below.setdefault(joint.parent, []).append(joint)
    children = [joint.child for joint in joints.values()]
    twice = sorted({name for name in children if children.count(name) > 1})
    if twice:
        raise RobotError(f'The link "{twice[0]}" is the child of two joints; a robot is a tree.')
    roots = [name for name in links if name not in children]
    for name in roots:
        links[name].place = base
    waiting = list(roots)
    while waiting:
        link = links[waiting.pop()]
        for joint in below.get(link.name, []):
            links[joint.child].place = link.place @ joint.place
            waiting.append(joint.child)
    lost = [name for name, link in links.items() if link.place is None]
    if lost:
        raise RobotError(f'The link "{lost[0]}" hangs in a ring of joints that nothing carries; a robot is a tree.')


def read_robot(file, base, which_shapes="collision", packages=()):
    """(links, joints), by name in the order of the file, placed in space."""
    file = Path(file)
    try:
        robot = ElementTree.parse(file).getroot()
    except (OSError, ElementTree.ParseError) as error:
        raise RobotError(f"Cannot read {file}: {error}.") from error
    if robot.tag != "robot":
        raise RobotError(f"{file} is no URDF: it begins with <{robot.tag}>, not <robot>.")
    for element in robot:
        if element.tag not in OUTSIDE:
            raise RobotError(f"{file}: <{element.tag}> is no part of URDF; expand xacro first (xacro FILE > ROBOT.urdf).")
    links = by_name((read_link(element, which_shapes, file, dict(packages)) for element in robot.findall("link")),
                    "links", file)
    joints = by_name((read_joint(element, file) for element in robot.findall("joint")), "joints", file)
    place_links(links, joints, base)
    return links, joints
