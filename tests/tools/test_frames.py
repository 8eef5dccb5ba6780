"""The reader of frames as a user uses it, and meshes for other programs. Usage: test_frames.py SIMULATE"""
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import meshio
import numpy

import make_frames

HERE = Path(__file__).resolve().parent
TOOLS = HERE.parents[1] / "tools"
sys.path[:0] = [str(TOOLS), str(HERE.parent / "support")]
from lockstep_frames import FramesError, read_frames  # noqa: E402 (the path comes first)
from scene_xml import xml  # noqa: E402


class Frames(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def make(self, dim):
        make_frames.main(self.folder, dim)
        return read_frames(self.folder)

    def export(self, *arguments):
        return subprocess.run([TOOLS / "export-meshes", self.folder, *arguments], text=True, stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE)


class Reader(Frames):
    def test_names_values_and_places(self):
        for dim in (2, 3):
            frame = self.make(dim)[1]
            box, body = frame["fluid"], frame["body"]
            self.assertEqual(frame.names, ["fluid", "body", "body elements"])
            x, y, z = box.centres()
            numpy.testing.assert_allclose(x, 1.0625 + 0.125 * numpy.arange(8))
            self.assertEqual((len(y), len(z)), (6, 4 if dim == 3 else 1))
            smoke = box.values("smoke").reshape(len(z), len(y), len(x))  # x + t
            numpy.testing.assert_allclose(smoke, numpy.broadcast_to(x + 0.5, smoke.shape))
            self.assertEqual(body.points().shape, (4, 3))
            self.assertEqual(body.cells().shape, (4, dim))

    def test_what_is_not_there_is_named(self):
        frame = self.make(3)[0]
        with self.assertRaisesRegex(FramesError, "no 'ball', but fluid, body, body elements"):
            frame["ball"]
        with self.assertRaisesRegex(FramesError, "'fluid' has no field 'heat'; there are: smoke, velocity"):
            frame["fluid"].values("heat")

    def test_the_program_of_the_manual(self):
        self.make(3)
        result = subprocess.run([sys.executable, HERE / "read_frames.py", self.folder, "body"], text=True, check=True,
                                stdout=subprocess.PIPE, cwd=TOOLS.parent)
        self.assertEqual(result.stdout.splitlines()[1],
                         "t = 0.5 s: 4 simplices around [ 1.5    0.375 -0.1  ], at most 0.5 m/s between x = 1.0625 and 1.9375 m")


class Export(Frames):
    def test_every_format_reads_back(self):
        body = self.make(3)[1]["body"]
        for kind in ("vtu", "vtk", "stl", "obj", "ply", "off", "msh", "xdmf"):
            with self.subTest(kind):
                result = self.export("--format", kind, "--frame", "1")
                self.assertEqual((result.returncode, result.stderr), (0, ""))
                mesh = meshio.read(self.folder / "meshes" / f"body-000001.{kind}")
                corners = mesh.points[mesh.get_cells_type("triangle")]
                wanted = body.points()[body.cells()]
                # Formats differ in the order of vertices, not of triangles and their corners.
                numpy.testing.assert_allclose(corners, wanted, atol=1e-6)

    def test_elements_of_all_frames(self):
        self.make(3)
        self.assertEqual(self.export("--elements").returncode, 0)
        for number in (0, 1):
            mesh = meshio.read(self.folder / "meshes" / f"body_elements-{number:06d}.vtu")
            self.assertEqual(mesh.get_cells_type("tetra").tolist(), [[0, 2, 1, 3]])

    def test_what_a_format_cannot_hold(self):
        self.make(2)
        result = self.export("--format", "stl")
        self.assertEqual(result.returncode, 2)
        self.assertIn("'body' consists of line cells, but .stl holds triangles alone", result.stderr)

    def test_a_scene_reads_what_was_written(self):
        """The centre of mass of a tetrahedron is the mean of its corners."""
        self.make(3)
        soft = {"Type": "deformable body", "Material": {"Young's Modulus": 1e5}}
        for kind, name, body in [(kind, "body", {"Type": "rigid body"}) for kind in ("obj", "off", "stl")] + [
                ("msh", "body_elements", soft)]:
            with self.subTest(kind):
                self.export("--format", kind, "--frame", "1", "--elements" if body is soft else "--format=" + kind)
                (self.folder / "scene.xml").write_text(xml("Scene", {
                    "Dimension": 3, "Domain": {"Lower": (1., 0., -.5), "Upper": (2., 1., .5), "Cells": (16, 16, 16)},
                    "Fluid": {"Density": 1.}, "Solids": {"Body": {
                        **body, "Density": 2., "Geometry": {"Shape": "file", "File": f"meshes/{name}-000001.{kind}"}}},
                    "Time": {"End": 1., "Fixed Step": .001}, "Output": {"Frames": False}}))
                subprocess.run([SIMULATE, self.folder / "scene.xml", "--output", self.folder / "run", "--steps", "1", "--quiet"],
                               check=True)
                lines = (self.folder / "run" / "bodies.csv").read_text().splitlines()
                names, row = (line.split(",") for line in lines[-2:])
                found = [float(dict(zip(names, row))[axis]) for axis in "xyz"]
                numpy.testing.assert_allclose(found, (1.5, .375, -.1), atol=1e-7)


if __name__ == "__main__":
    SIMULATE = sys.argv.pop(1)
    unittest.main()
