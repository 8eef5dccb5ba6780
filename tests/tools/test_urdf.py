"""Robots as scenes: where bodies and joints come to be, by hand; that they run; what is refused. Usage: test_urdf.py SIMULATE"""
import csv
import math
import struct
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree
from pathlib import Path

TOOL = Path(__file__).resolve().parents[2] / "tools" / "urdf-to-scene"
LINK = """<link name="{name}">
  <inertial><origin xyz="0 0 {centre}"/><mass value="{mass}"/>
    <inertia ixx="{ixx}" iyy="{ixx}" izz="{izz}" ixy="0" ixz="0" iyz="0"/></inertial>
  <collision><origin xyz="0 0 {centre}"/><geometry>{shape}</geometry></collision></link>"""
JOINT = """<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>
  <origin xyz="{xyz}" rpy="{rpy}"/><axis xyz="{axis}"/>{more}</joint>"""
BOX = '<box size="0.1 0.1 0.4"/>'
LIMIT = '<limit lower="-0.5" upper="1" effort="3" velocity="2"/>'


def link(name, shape=BOX, mass=2., centre=.2, inertia=None):
    """A box, unless told else, that stands on the origin of the link."""
    ixx, izz = inertia or (mass / 12 * (.1**2 + .4**2), mass / 12 * 2 * .1**2)
    return LINK.format(name=name, shape=shape, mass=mass, centre=centre, ixx=ixx, izz=izz)


def joint(name, kind, parent, child, xyz="0 0 0", rpy="0 0 0", axis="0 1 0", more=""):
    if kind in ("revolute", "prismatic") and not more:
        more = LIMIT
    return JOINT.format(name=name, kind=kind, parent=parent, child=child, xyz=xyz, rpy=rpy, axis=axis, more=more)


def robot(*parts):
    return "<?xml version='1.0'?>\n<robot name='test'>" + "\n".join(parts) + "</robot>"


ALL_KINDS = robot(
    link("base"), link("arm"), link("wheel", '<cylinder radius="0.1" length="0.05"/>', 1., 0,
                                    (1 / 12 * (3 * .01 + .0025), .005)),
    link("ram", '<sphere radius="0.1"/>', 1., 0, (.004, .004)), link("plate"), link("buoy"), link("tip"),
    '<link name="flange"/>',
    joint("shoulder", "revolute", "base", "arm", "0 0 0.5", "0 1.5707963267948966 0"),
    joint("axle", "continuous", "arm", "wheel", "0.3 0 0.4", more='<dynamics damping="0.5"/>'),
    joint("pump", "prismatic", "base", "ram", "0 0.6 0", axis="0 0 1"),
    joint("table", "planar", "base", "plate", "0 -0.6 0", axis="0 0 1"),
    joint("loose", "floating", "base", "buoy", "0.9 0 0"),
    joint("bolts", "fixed", "arm", "flange", "0 0 0.45"), joint("glue", "fixed", "flange", "tip", "0 0 0.1"))


class Robots(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def convert(self, text, *options):
        (self.folder / "robot.urdf").write_text(text)
        return subprocess.run([TOOL, self.folder / "robot.urdf", self.folder / "scene.xml", *options],
                              capture_output=True, text=True)

    def scene(self, text, *options):
        result = self.convert(text, *options)
        self.assertEqual(result.returncode, 0, result.stderr)
        return ElementTree.parse(self.folder / "scene.xml").getroot(), result.stderr

    def numbers(self, root, *path):
        for name in path:
            root = next(child for child in root if child.get("name") == name)
        return [float(word) for word in root.get("value").strip("{}").split(",")]

    def assert_near(self, found, expected):
        self.assertEqual(len(found), len(expected))
        for one, other in zip(found, expected):
            self.assertAlmostEqual(one, other, delta=1e-12)

    def test_bodies_and_joints_are_where_they_belong(self):
        root, notes = self.scene(ALL_KINDS, "--position", "0", "0", "1")
        self.assertEqual(notes.count("note:"), 1)
        self.assertIn('limits of effort and velocity are left out ("shoulder", "pump")', notes)
        self.assert_near(self.numbers(root, "Solids", "base", "Position"), (0, 0, 1.2))
        # The shoulder turns z of the arm to x of space, and x to -z.
        self.assert_near(self.numbers(root, "Solids", "arm", "Position"), (.2, 0, 1.5))
        self.assert_near(self.numbers(root, "Solids", "arm", "Rotation"), (0, math.pi / 2, 0))
        self.assert_near(self.numbers(root, "Joints", "shoulder", "Axis"), (0, 1, 0))
        self.assert_near(self.numbers(root, "Joints", "shoulder", "Point"), (0, 0, 1.5))
        self.assert_near(self.numbers(root, "Joints", "shoulder", "Limits", "Lower"), (-.5,))
        self.assert_near(self.numbers(root, "Solids", "wheel", "Position"), (.4, 0, 1.2))
        self.assert_near(self.numbers(root, "Joints", "axle", "Damping"), (.5,))
        self.assert_near(self.numbers(root, "Solids", "tip", "Position"), (.75, 0, 1.5))
        kinds = {one.get("name"): one.find("Parameter[@name='Type']").get("value") for one in
                 root.find("ParameterList[@name='Joints']")}
        self.assertEqual(kinds, {"shoulder": "hinge", "axle": "hinge", "pump": "slider", "table": "planar",
                                 "glue": "weld"})
        glue = root.find("ParameterList[@name='Joints']/ParameterList[@name='glue']/Parameter[@name='Solids']")
        self.assertEqual(glue.get("value"), "{arm, tip}")

    def run_steps(self, n=2):
        """history.csv and bodies.csv, rows by column."""
        done = subprocess.run([sys.argv[1], self.folder / "scene.xml", "--output", self.folder / "run", "--steps", str(n),
                               "--set", "Domain/Cells={16, 16, 16}", "--set", "Domain/Lower={-2, -2, -2}",
                               "--set", "Domain/Upper={2, 2, 2}", "--quiet"], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        return [list(csv.DictReader(line for line in (self.folder / "run" / name).read_text().splitlines()
                                    if not line.startswith("#"))) for name in ("history.csv", "bodies.csv")]

    def test_it_runs(self):
        self.scene(ALL_KINDS)
        history, _ = self.run_steps()
        self.assertLess(float(history[-1]["momentum_error"]), 1e-10)

    def test_a_mesh_runs(self):
        """A cube as an STL file in millimetres, turned and on a hinge, moves as a box does."""
        corners = [(x, y, z) for x in (-200., 200.) for y in (-200., 200.) for z in (-200., 200.)]
        faces = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))
        triangles = [half for a, b, c, d in faces for half in ((a, b, c), (a, c, d))]
        with open(self.folder / "cube.STL", "wb") as file:
            file.write(bytes(80) + struct.pack("<I", len(triangles)))
            for triangle in triangles:
                file.write(struct.pack("<12fH", 0, 0, 0, *(x for k in triangle for x in corners[k]), 0))
        ends = []
        for shape in ('<mesh filename="cube.STL" scale="0.001 0.001 0.001"/>', '<box size="0.4 0.4 0.4"/>'):
            cube = link("hammer", shape, 200., .6, (200 / 6 * .16, 200 / 6 * .16))
            self.scene(robot(link("stand"), cube, joint("j", "continuous", "stand", "hammer", "0.1 0.2 0.3", "0.3 0.4 0.5")),
                       "--fixed-base")
            history, bodies = self.run_steps(3)
            self.assertLess(float(history[-1]["momentum_error"]), 1e-10)
            ends.append(next(row for row in reversed(bodies) if row["name"] == "hammer"))
        self.assertGreater(abs(float(ends[0]["wy"])), .01)
        for name in ("x", "y", "z", "vx", "vy", "vz", "wx", "wy", "wz"):
            self.assertAlmostEqual(float(ends[0][name]), float(ends[1][name]), delta=1e-5, msg=name)

    def test_a_fixed_base_and_a_mass_without_shape(self):
        bare = link("arm").split("<collision>")[0] + "</link>"
        root, _ = self.scene(robot(link("base"), bare, joint("j", "continuous", "base", "arm")), "--fixed-base")
        self.assert_near(self.numbers(root, "Solids", "arm", "Position"), (0, 0, .2))
        self.assert_near(sorted(self.numbers(root, "Solids", "arm", "Geometry", "Size")), (.1, .1, .4))
        seen = root.find("ParameterList[@name='Solids']/ParameterList[@name='arm']/Parameter[@name='Seen by Fluid']")
        self.assertEqual(seen.get("value"), "false")
        weld = root.find("ParameterList[@name='Joints']/ParameterList[@name='base to space']")
        self.assertIsNotNone(weld)

    def test_what_runs_on_a_rail_without_mass(self):
        """As files of others have it, whose rail has no more than a shape to be drawn."""
        rail = '<link name="rail"><visual><geometry><box size="3 0.05 0.05"/></geometry></visual></link>'
        cart_and_pole = (link("cart", '<box size="0.5 0.5 0.2"/>', 100., 0, (100 / 12 * (.25 + .04), 100 / 12 * .5)), link("pole", mass=20.))
        root, _ = self.scene(robot(rail, *cart_and_pole, joint("slide", "prismatic", "rail", "cart", axis="1 0 0"),
                                   joint("swing", "continuous", "cart", "pole", rpy="0 0.3 0")))
        slide = root.find("ParameterList[@name='Joints']/ParameterList[@name='slide']")
        self.assertEqual(slide.find("Parameter[@name='Solids']").get("value"), "{space, cart}")
        history, bodies = self.run_steps(3)
        self.assertLess(float(history[-1]["momentum_error"]), 1e-10)
        cart = [row for row in bodies if row["name"] == "cart"][-1]
        self.assertGreater(abs(float(cart["x"])), 1e-6)  # the pole falls, and pushes it
        for axis in "yz":
            self.assertAlmostEqual(float(cart[axis]), 0, delta=1e-9)

    def test_what_even_masses_cannot_be_is_told(self):
        _, notes = self.scene(robot(link("base", inertia=(1., .1))))
        self.assertIn("off the file's", notes)
        shifted = link("base").replace('<collision><origin xyz="0 0 0.2"/>', '<collision><origin xyz="0 0 0.3"/>')
        _, notes = self.scene(robot(shifted))
        self.assertIn("0.1 m from that of its shape", notes)

    def test_a_mesh_fits_into_the_tank(self):
        (self.folder / "cube.obj").write_text("".join(
            f"v {x} {y} {z}\n" for x in (-.2, .2) for y in (-.2, .2) for z in (-.2, .2)) +
            "".join(f"f {face}\n" for face in ("1 2 4 3", "5 7 8 6", "1 5 6 2", "3 4 8 7", "1 3 7 5", "2 6 8 4")))
        cube = link("base", '<mesh filename="cube.obj"/>', 6., 0, (.16, .16))
        root, _ = self.scene(robot(cube))
        self.assertGreater(min(self.numbers(root, "Domain", "Upper")), .3)
        done = subprocess.run([sys.argv[1], self.folder / "scene.xml", "--validate"], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_refuses_by_name(self):
        two = link("base"), link("arm")
        cases = (
            (robot(*two, joint("elbow", "revolute", "base", "arm", more=LIMIT + '<mimic joint="x"/>')), "elbow.*mimic"),
            (robot(*two, joint("elbow", "spherical", "base", "arm")), 'elbow.*"spherical"'),
            (robot(*two, joint("elbow", "continuous", "base", "arm", more='<dynamics friction="1"/>')), "friction"),
            (robot(*two, joint("elbow", "continuous", "base", "leg")), 'link "leg", but there is none'),
            (robot(*two, joint("a", "fixed", "base", "arm"), joint("b", "fixed", "base", "arm")), "child of two"),
            (robot(*two, joint("a", "fixed", "base", "arm"), joint("b", "fixed", "arm", "base")), "ring"),
            (robot(link("base", '<mesh filename="hull.dae"/>')), "hull.dae.*STL"),
            (robot(link("base", '<mesh filename="package://boat/hull.stl"/>')), "--package boat="),
            (robot(link("base", '<box size="1 1"/>')), "3 numbers"),
            (robot(link("base", '<box size="1 -1 1"/>')), 'size is "1 -1 1"; sizes are greater than 0'),
            (robot(link("base", '<sphere radius="-0.1"/>')), 'radius is "-0.1"'),
            (robot(link("base", '<cylinder radius="0.1" length="0"/>')), 'length is "0"'),
            (robot(link("base"), '<link name="eye"/>', joint("neck", "continuous", "base", "eye")), "no mass.*neck"),
            (robot(link("base", '<mesh filename="hull.stl"/>')), "no file .*hull.stl"),
            (robot(*two, joint("elbow", "revolute", "base", "arm", more='<limit lower="0.2" upper="1"/>')), "leave out 0"),
            (robot(*two, '<joint name="elbow" type="fixed"><child link="arm"/></joint>'), 'elbow.*<parent> lacks "link"'),
            (robot(link("base"), link("base")), 'two links are called "base"'), (robot("<link/>"), 'a link lacks "name"'),
            (robot(link("base", mass=-2.)), 'link "base" has a mass of -2 kg'),
            (robot(link("base", inertia=(0., 0.))), r'link "base" has a mass and the moments of inertia \[0.0, 0.0, 0.0\]'),
            (robot(link("base", inertia=(-1., 1.))), 'which no body has'),
            (robot("<xacro:macro xmlns:xacro='x'/>"), "xacro"), ("<sdf/>", "no URDF"), ("<robot>", "Cannot read"))
        for text, sentence in cases:
            result = self.convert(text)
            self.assertEqual(result.returncode, 2, result.stdout)
            self.assertRegex(result.stderr, sentence)
            self.assertNotIn("Traceback", result.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
