"""Bad input: surfaces and volumes from files."""
import re

from bad_input import DENSITY, GEOMETRY, RADIUS, SCENE_3D, SOFT_SCENE_3D, Case, value
from program import SCENE

TETRAHEDRON = """v 0 0 0
v 1 0 0
v 0 1 0
v 0 0 1
f 1 3 2
f 1 2 4
f 1 4 3
f 2 3 4
"""
BLANKS = "\n" * 20000000  # makes the file as long as what it announces
TOO_MANY_POINTS = """# vtk DataFile Version 3.0
a mesh
ASCII
DATASET UNSTRUCTURED_GRID
POINTS 20000000 double
"""
FLAT = """v 0 0 0
v 1 0 0
v 0 1 0
f 1 2 3
f 1 3 2
"""

# The edge from 1 to 2 goes the same way in both.
CREASED = """v 0 0 0
v 1 0 0
v 0 1 0
v 0 -1 1
f 1 2 3
f 1 2 4
"""

INNER_TETRAHEDRON = """v .1 .1 .1
v .3 .1 .1
v .1 .3 .1
v .1 .1 .3
f 5 7 6
f 5 6 8
f 5 8 7
f 6 7 8
"""
TWO_TETRAHEDRA = """$MeshFormat
2.2 0 8
$EndMeshFormat
$Nodes
5
1 0 0 0
2 .3 0 0
3 0 .3 0
4 0 0 .3
5 .3 .3 .3
$EndNodes
$Elements
2
1 4 2 0 0 1 2 3 4
2 4 2 0 0 2 3 4 5
$EndElements
"""
BOW_TIE = """v 0 0 0
v .4 .2 0
v .4 0 0
v 0 .2 0
l 1 2
l 2 3
l 3 4
l 4 1
"""


def mesh(text, name="body.obj"):
    """A 3D scene whose body is read from a file."""
    return {"scene": SCENE_3D, "files": [(name, text)] if text is not None else [],
            "change": (GEOMETRY, value("Shape", "string", "file") + value("File", "string", name))}


CASES = [
    Case("a flat volume", ["Ball", "flat"], **mesh(FLAT)),
    Case("an OFF file of too many vertices", ["body.off, line 2", "20000000 vertices or elements", "at most 10000000"],
         **mesh("OFF\n20000000 3 0\n" + BLANKS, "body.off")),
    Case("a volume mesh of too many points", ["body.vtk, line 5", "20000000 vertices or elements", "at most 10000000"],
         scene=SOFT_SCENE_3D, files=[("body.vtk", TOO_MANY_POINTS + BLANKS)],
         change=(GEOMETRY, value("Shape", "string", "file") + value("File", "string", "body.vtk"))),
    Case("a mesh in micrometres", ["The solid \"Ball\" is 900000 m long, in a domain of", "\"Scale\""],
         **mesh(re.sub(r"\b1\b(?=.*$)", "9e5", TETRAHEDRON.split("f", 1)[0], flags=re.M) + "f" + TETRAHEDRON.split("f", 1)[1])),
    Case("no mesh", ["body.obj", "cannot open"], **mesh(None)),
    Case("a mesh that is a pipe", ["pipe.obj", "pipe, not a file"], **mesh(None, "pipe.obj")),
    Case("a volume mesh that is a pipe", ["pipe.vtk", "pipe, not a file"],
         **{**mesh(None, "pipe.vtk"), "scene": SOFT_SCENE_3D}),
    Case("an open mesh", ["'Ball'", "should enclose a volume"], **mesh(TETRAHEDRON.replace("f 2 3 4\n", ""))),
    Case("a triangle turned against its neighbours", "oriented against each other",
         **mesh(TETRAHEDRON.replace("f 2 3 4", "f 2 4 3"))),
    Case("a shell of two sides", ["'Ball'", "is a shell of two sides", "1 edge whose two triangles are oriented against each other", "\"Orient\""],
         scene=SCENE_3D, files=[("body.obj", CREASED)],
         change=[(GEOMETRY, value("Shape", "string", "file") + value("File", "string", "body.obj") + value("Thin Shell", "bool", "true")),
                 (DENSITY, value("Surface Density", "double", "500"))]),
    Case("a coordinate nan", ["body.obj, line 2", "'nan'", "finite"], **mesh(TETRAHEDRON.replace("v 1 0 0", "v nan 0 0"))),
    Case("a coordinate inf", ["body.obj, line 2", "'-inf'"], **mesh(TETRAHEDRON.replace("v 1 0 0", "v 1 -inf 0"))),
    Case("a coordinate beyond doubles", ["body.obj, line 2", "'1e999'"],
         **mesh(TETRAHEDRON.replace("v 1 0 0", "v 1e999 0 0"))),
    Case("a hexadecimal coordinate", ["body.obj, line 2", "'0x10'"],
         **mesh(TETRAHEDRON.replace("v 1 0 0", "v 0x10 0 0"))),
    Case("a coordinate that a zero byte ends", ["body.obj, line 2", "expected a number"],
         **mesh(TETRAHEDRON.replace("v 1 0 0", "v 1\0 0 0"))),
    Case("a vertex without number", ["body.obj, line 5", "'/1'"], **mesh(TETRAHEDRON.replace("f 1 3 2", "f /1 3 2"))),
    Case("a huge vertex number", ["body.obj, line 5", "'99999999999999999999'"],
         **mesh(TETRAHEDRON.replace("f 1 3 2", "f 1 3 99999999999999999999"))),
    Case("a hole in the file's numbers", ["body.obj", "1 hole, with 3 edges", "vertex 2 at (1, 0, 0)", "line 5",
                                          "\"Weld\"", "\"Thin Shell\""],
         **mesh(TETRAHEDRON.replace("f 2 3 4\n", ""))),
    Case("a hole that faces outwards", ["1 of its 2 closed parts faces the wrong way", "bounds a hole", "line 13"],
         **mesh(TETRAHEDRON + INNER_TETRAHEDRON)),
    Case("an outline that crosses itself", ["crosses itself in 1 pair of segments", "line 5", "line 7"],
         arguments=["--validate"], scene=SCENE, files=[("body.obj", BOW_TIE)],
         change=(GEOMETRY, value("Shape", "string", "file") + value("File", "string", "body.obj"))),
    Case("welded to nothing", "\"Weld\" = 9", files=[("body.obj", TETRAHEDRON)], scene=SCENE_3D,
         change=(GEOMETRY, value("Shape", "string", "file") + value("File", "string", "body.obj") +
                 value("Weld", "double", "9"))),
    Case("a ball that is welded", "has no \"Weld\"", change=(RADIUS, RADIUS + value("Weld", "double", "1"))),
    Case("a vertex that is not there", ["line 5", "vertex 9 does not exist"],
         **mesh(TETRAHEDRON.replace("f 1 3 2", "f 1 3 9"))),
    Case("a mesh without faces", "no triangles", **mesh(TETRAHEDRON.split("f", 1)[0])),
    Case("an unknown kind of file", ["body.ply", "\"assimp export body.ply body.stl\""], **mesh(TETRAHEDRON, "body.ply")),
    Case("a surface in place of tetrahedra", ["body.stl: unknown kind", "\"gmsh -3 body.geo -o body.msh\"", "Merge \"body.stl\""],
         **{**mesh("solid", "body.stl"), "scene": SOFT_SCENE_3D}),
    Case("a shape in place of tetrahedra", ["body.step: unknown kind", "\"gmsh -3 body.step -o body.msh\""],
         **{**mesh("ISO-10303-21;", "body.step"), "scene": SOFT_SCENE_3D}),
    Case("a file that announces more than it has bytes", ["body.off, line 2", "1000000000 entries are announced", "damaged"],
         **mesh("OFF\n1000000000 1000000000 0\n0 0 0\n", "body.off")),
    Case("a block of more nodes than bytes", ["body.msh, line 6", "2000000000 entries", "damaged"],
         scene=SOFT_SCENE_3D, change=(GEOMETRY, value("Shape", "string", "file") + value("File", "string", "body.msh")),
         files=[("body.msh", "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 2000000000 1 2000000000\n3 1 0 2000000000\n")]),
    Case("an element of more corners than its type has", ["body.msh, line 15", "element 24 of Gmsh type 2 has 5 corners, but must have 3"],
         scene=SOFT_SCENE_3D, change=(GEOMETRY, value("Shape", "string", "file") + value("File", "string", "body.msh")),
         files=[("body.msh", TWO_TETRAHEDRA.replace("2 4 2 0 0", "24 2 0 0"))]),
    Case("a mesh that is no mesh", "OFF", **mesh("solid", "body.off")),
]
