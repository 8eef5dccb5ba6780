"""The reader of frames as a user uses it, and meshes for other programs. Usage: test_frames.py SIMULATE"""
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import h5py
import meshio
import numpy

import make_frames
import make_run

HERE = Path(__file__).resolve().parent
TOOLS = HERE.parents[1] / "tools"
sys.path[:0] = [str(TOOLS), str(HERE.parent / "support")]
from lockstep_frames import FramesError, read_frames  # noqa: E402 (the path comes first)
from report_page.blobs import Blobs  # noqa: E402
from report_page.frames import FramePacker  # noqa: E402
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


def cut_short(path):
    content = path.read_bytes()
    path.write_bytes(content[:len(content) // 2])


def changed(change):
    """Damages the HDF5 file as it is open."""
    def damage(folder):
        with h5py.File(folder / "frames.h5", "a") as file:
            change(file)
    return damage


def replaced(name, values):
    def change(file):
        del file[name]
        if values is not None:
            file[name] = values
    return changed(change)


def rewritten(old, new):
    """Damages the index."""
    def damage(folder):
        text = (folder / "frames.xmf").read_text()
        assert old in text
        (folder / "frames.xmf").write_text(text.replace(old, new))
    return damage


LAST = "/frame-000001"  # the frame that all of these tools read
# Damages, what the message says beside the file, and whether they are of the solid alone.
DAMAGES = {
    "cut short": (lambda folder: cut_short(folder / "frames.h5"), "frames.h5: cannot read", False),
    "empty": (lambda folder: (folder / "frames.h5").write_bytes(b""), "frames.h5: cannot read", False),
    "no HDF5": (lambda folder: (folder / "frames.h5").write_text("hello"), "no HDF5 file", False),
    "gone": (lambda folder: (folder / "frames.h5").unlink(), "frames.h5, which frames.xmf names, is not there", False),
    "a folder": (lambda folder: ((folder / "frames.h5").unlink(), (folder / "frames.h5").mkdir()), "is not there", False),
    "no field": (replaced(LAST + "/fluid/smoke", None), "holds no dataset '/frame-000001/fluid/smoke'", False),
    "no fluid": (replaced(LAST + "/fluid", None), "holds no dataset '/frame-000001/fluid/", False),
    "no frame": (replaced(LAST, None), "holds no dataset '/frame-000001/", False),
    "a group": (changed(lambda file: (file.pop(LAST + "/fluid/smoke"), file.create_group(LAST + "/fluid/smoke"))), "holds no dataset", False),
    "text": (replaced(LAST + "/fluid/smoke", "hello"), "'/frame-000001/fluid/smoke' holds no numbers", False),
    "too few values": (replaced(LAST + "/fluid/smoke", numpy.zeros(7)), "holds 7 values, but frames.xmf says", False),
    "an empty field": (replaced(LAST + "/fluid/smoke", h5py.Empty("f")), "holds 0 values", False),
    "no vertices": (replaced(LAST + "/body/vertices", None), "holds no dataset '/frame-000001/body/vertices'", True),
    "no corners": (replaced(LAST + "/body/simplices", None), "holds no dataset '/frame-000001/body/simplices'", True),
    "vertices of another body": (replaced(LAST + "/body/vertices", numpy.zeros((3, 3))), "holds 9 values", True),
    "vertices that are text": (replaced(LAST + "/body/vertices", "hello"), "holds no numbers", True),
    "a vertex that is not there": (changed(lambda file: file[LAST + "/body/simplices"].write_direct(numpy.full(file[LAST + "/body/simplices"].shape, 99, "i4"))),
                                   "'body' has the vertex number 99, but 4 vertices", True),
    "an index cut short": (lambda folder: cut_short(folder / "frames.xmf"), "frames.xmf is not proper XML", True),
    "an empty index": (lambda folder: (folder / "frames.xmf").write_bytes(b""), "frames.xmf is not proper XML", True),
    "an index of bytes": (lambda folder: (folder / "frames.xmf").write_bytes(bytes(range(256))), "frames.xmf is not proper XML", True),
    "an index without shapes": (rewritten("Topology", "Topologie"), "is no index of frames", True),
    "an index without places": (rewritten("Geometry", "Place"), "is no index of frames", True),
    "an index of unknown shapes": (rewritten('TopologyType="3DCoRectMesh"', 'TopologyType="Round"'), "is no index of frames", True),
    "an index with words for numbers": (rewritten('<Time Value="0.5"/>', '<Time Value="late"/>'), "is no index of frames", True),
    "an index that names no dataset": (rewritten("frames.h5:", "frames.h5 "), "names no dataset", True),
    "an index of other cells": (rewritten(' 7 9"/>', ' 7 5"/>'), "is no index of frames", True)}


class Damaged(Frames):
    """One sentence, exit code 2, and no picture, page or mesh of half a frame."""

    def check(self, command, words, output):
        result = subprocess.run(command, text=True, capture_output=True)
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)
        self.assertIn(words, result.stderr)
        self.assertFalse(output.exists())

    def test_each_tool_says_what_is_damaged(self):
        for number, (name, (damage, words, _)) in enumerate(DAMAGES.items()):
            for dim in (2, 3):
                with self.subTest(name, dim=dim), tempfile.TemporaryDirectory() as folder:
                    folder = Path(folder)
                    make_run.main(folder, dim)
                    damage(folder)
                    if (number + dim) % 2 == 0:  # they read alike; both take a second to begin
                        self.check([TOOLS / "plot-frame", folder, "--frame", "1"], words, folder / "frame.png")
                    else:
                        self.check([TOOLS / "report", folder], words, folder / "report.html")

    def test_meshes_are_whole_or_not_there(self):
        for dim in (2, 3):
            for name, (damage, words, is_of_solid) in DAMAGES.items():
                if not is_of_solid:
                    continue
                with self.subTest(name, dim=dim), tempfile.TemporaryDirectory() as folder:
                    folder = Path(folder)
                    make_frames.main(folder, dim)
                    damage(folder)
                    self.check([TOOLS / "export-meshes", folder, "--frame", "1"], words, folder / "meshes/body-000001.vtu")

    def test_a_run_that_goes_on_is_watched_without_them(self):
        for name, (damage, _, _) in DAMAGES.items():
            with self.subTest(name), tempfile.TemporaryDirectory() as folder:
                make_run.main(folder, 2)
                damage(Path(folder))
                packed = FramePacker(Blobs(), 200).pack(folder)
                self.assertLess(len(packed["frames"]), 2)

    def test_a_run_without_frames_has_a_page(self):
        make_run.main(self.folder, 2)
        (self.folder / "frames.xmf").unlink()
        result = subprocess.run([TOOLS / "report", self.folder], text=True, capture_output=True)
        self.assertEqual((result.returncode, result.stderr), (0, ""))


if __name__ == "__main__":
    SIMULATE = sys.argv.pop(1)
    unittest.main()
