"""plot-frame and render on the folder of make_frames.py: smoke = x + t, velocity = (0, t, 0), one body."""
import importlib.machinery
import importlib.util
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy
from matplotlib.image import imread

import make_frames

TOOLS = Path(__file__).resolve().parents[2] / "tools"
sys.path.insert(0, str(TOOLS))
loader = importlib.machinery.SourceFileLoader("plot_frame", str(TOOLS / "plot-frame"))
plot_frame = importlib.util.module_from_spec(importlib.util.spec_from_loader("plot_frame", loader))
loader.exec_module(plot_frame)


class Pictures(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def make(self, dim):
        make_frames.main(self.folder.name, dim)
        return plot_frame.read_frames(self.folder.name)

    def run_tool(self, name, *arguments):
        return subprocess.run([TOOLS / name, self.folder.name, *arguments], text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE)


class PlotFrame(Pictures):
    def test_slice_across_each_axis(self):
        frame = self.make(3)[1]
        self.assertEqual(frame.time, 0.5)
        box = frame.boxes[0]
        smoke = plot_frame.slice_of(box, "smoke", 2, 0.0)
        numpy.testing.assert_allclose(smoke[3], 1.5 + 0.125 * (numpy.arange(8) + 0.5))
        across_x = plot_frame.slice_of(box, "smoke", 0, 1.3)     # third layer: its centre is at 1.3125
        self.assertEqual(across_x.shape, (4, 6))
        numpy.testing.assert_allclose(across_x, 1.8125)
        numpy.testing.assert_allclose(plot_frame.slice_of(box, "velocity", 1, 0.3), 0.5)

    def test_outline_of_a_tetrahedron(self):
        # Half way up, the outline has half the size of the base: a width of 0.25.
        segments = plot_frame.outline(self.make(3)[0].surfaces[0], 2, 0.0)
        self.assertEqual(segments.shape, (3, 2, 2))
        numpy.testing.assert_allclose(numpy.ptp(segments[..., 0]), 0.25)

    def test_two_dimensions(self):
        frame = self.make(2)[0]
        self.assertEqual(plot_frame.slice_of(frame.boxes[0], "smoke", 2, 0.0).shape, (6, 8))
        self.assertEqual(plot_frame.outline(frame.surfaces[0], 2, 0.0).shape, (4, 2, 2))

    def test_program(self):
        for dim in (2, 3):
            self.make(dim)
            result = self.run_tool("plot-frame")
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertGreater(imread(Path(self.folder.name) / "frame.png").std(), 0.1)

    def test_messages(self):
        self.assertIn("holds no frames.xmf", self.run_tool("plot-frame").stderr)
        self.make(3)
        for arguments, message in [(["--field", "smok"], "the run wrote: smoke, velocity"),
                                   (["--frame", "7"], "frames 0 to 1"),
                                   (["--position", "9"], "outside the fluid's box")]:
            result = self.run_tool("plot-frame", *arguments)
            self.assertEqual(result.returncode, 2)
            self.assertIn(message, result.stderr)


class Render(Pictures):
    def test_pictures(self):
        for dim, arguments in ((2, []), (3, []), (3, ["--volume", "--field", "smoke"]), (3, ["--field", "velocity"])):
            with self.subTest(dim=dim, arguments=arguments):
                self.make(dim)
                result = self.run_tool("render", "--size", "320x240", *arguments)
                self.assertEqual(result.returncode, 0, result.stderr)
                picture = imread(Path(self.folder.name) / "render.png")
                self.assertEqual(picture.shape[:2], (240, 320))
                # The scalar bar alone covers less than a tenth of the picture.
                coloured = numpy.ptp(picture[..., :3], axis=2) > 0.15
                self.assertGreater(coloured.mean(), 0.1)

    def test_movie(self):
        self.make(3)
        result = self.run_tool("render", "--movie", "--size", "320x240")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertGreater((Path(self.folder.name) / "render.mp4").stat().st_size, 1000)


if __name__ == "__main__":
    unittest.main()
