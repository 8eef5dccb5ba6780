"""plot-frame and render on the folder of make_frames.py: smoke = x + t, velocity = (0, t, 0), one body."""
import argparse
import importlib.machinery
import importlib.util
import subprocess
import sys
import tempfile
import unittest
import unittest.mock
from pathlib import Path

import h5py
import numpy
from matplotlib.image import imread

import make_frames
import make_run

TOOLS = Path(__file__).resolve().parents[2] / "tools"
sys.path.insert(0, str(TOOLS))
from virtual_screen import VirtualScreen  # noqa: E402 (the path comes first)


def load(name):
    """A program of tools/ as a module."""
    loader = importlib.machinery.SourceFileLoader(name.replace("-", "_"), str(TOOLS / name))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader(loader.name, loader))
    loader.exec_module(module)
    return module


plot_frame = load("plot-frame")


class FixedArray:
    """In place of an array in a file."""

    def __init__(self, values):
        self.values = values
        self.n_values = values.size

    def read(self, selection=...):
        return self.values[selection]


class Pictures(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def make(self, dim, drops=()):
        make_frames.main(self.folder.name, dim, drops)
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

    def test_a_smooth_slice_is_linear_and_ends_where_phi_does(self):
        box = self.make(3)[1].boxes[0]
        smoke, x = plot_frame.smooth_slice_of(box, "smoke", 2, 0.0), 1 + 0.125 / 8 * (numpy.arange(64) + 0.5)
        within = slice(4, -4)                                   # between the first centre and the last
        numpy.testing.assert_allclose(smoke[5, within], (x + 0.5)[within], atol=1e-12)
        phi = numpy.broadcast_to(1 + 0.125 * (numpy.arange(8) + 0.5) - 1.53, (6, 8))
        box.fields["phi"] = (FixedArray(numpy.repeat(phi[None], 4, axis=0)), *box.fields["smoke"][1:])
        wet = numpy.isfinite(plot_frame.smooth_slice_of(box, "smoke", 2, 0.0)[5])
        self.assertEqual(list(wet), list(x < 1.53))             # not where a cell ends, 1.5 or 1.625

    def test_outline_of_a_tetrahedron(self):
        # Half way up, the outline has half the size of the base: a width of 0.25.
        segments = plot_frame.outline(self.make(3)[0].surfaces[0], 2, 0.0)
        self.assertEqual(segments.shape, (3, 2, 2))
        numpy.testing.assert_allclose(numpy.ptp(segments[..., 0]), 0.25)

    def test_two_dimensions(self):
        frame = self.make(2)[0]
        self.assertEqual(plot_frame.slice_of(frame.boxes[0], "smoke", 2, 0.0).shape, (6, 8))
        self.assertEqual(plot_frame.outline(frame.surfaces[0], 2, 0.0).shape, (4, 2, 2))

    def test_closed_outlines_are_filled_where_there_is_no_fluid(self):
        frame = self.make(2)[0]
        box, square = frame.boxes[0], plot_frame.outline(frame.surfaces[0], 2, 0.0)
        shuffled = square[[2, 0, 3, 1]]
        shuffled[1] = shuffled[1][::-1]
        (polygon,) = plot_frame.loops(shuffled)
        self.assertEqual({tuple(corner) for corner in polygon}, {(1.25, .25), (1.5, .25), (1.5, .5), (1.25, .5)})
        self.assertEqual(plot_frame.loops(square[:3]), [])      # open
        self.assertEqual(len(plot_frame.loops(numpy.concatenate((square, square + 1)))), 2)
        self.assertFalse(plot_frame.without_fluid(box, polygon, 2, 0.0))   # the run does not say
        for value in (0.0, 1.0):
            fluid = numpy.ones((6, 8))
            fluid[2:4, 2:4] = value                              # the cells within the square
            box.fields["fluid"] = (FixedArray(fluid), *box.fields["smoke"][1:])
            self.assertEqual(plot_frame.without_fluid(box, polygon, 2, 0.0), value == 0)

    def test_a_thin_body_in_the_oblique_is_a_body(self):
        """All cells of a thin body but the two that lie all in it are cut, and hold fluid; a shell there has fluid in those as well."""
        box = self.make(2)[0].boxes[0]                           # cells of 0.125 m from (1, 0) on
        polygon = numpy.array([(1.06, 0.21), (1.21, 0.06), (1.68, 0.53), (1.53, 0.68)])
        fluid = numpy.ones((6, 8))
        box.fields["fluid"] = (FixedArray(fluid), *box.fields["smoke"][1:])
        self.assertFalse(plot_frame.without_fluid(box, polygon, 2, 0.0))
        fluid[2, 2] = fluid[3, 3] = 0
        self.assertTrue(plot_frame.without_fluid(box, polygon, 2, 0.0))

    def test_colours_of_a_movie(self):
        """One scale for all frames, which a single cell does not widen."""
        frames = self.make(2)
        options = argparse.Namespace(position=None, axis=2, field="velocity")
        self.assertEqual(plot_frame.colours_of(frames, options), [0, 0.5])
        calm, one_cell = numpy.linspace(-1, 2, 2001), numpy.linspace(-1, 2, 2001)
        one_cell[-1], calm[0] = 90, numpy.nan
        low, high = plot_frame.range_of_colours([calm, one_cell], False)
        self.assertAlmostEqual(low, -1, delta=0.01)
        self.assertAlmostEqual(high, 2, delta=0.01)
        self.assertEqual(plot_frame.range_of_colours([one_cell], True, 1.0), [0, 90])

    def test_elements_are_no_surfaces(self):
        for dim in (2, 3):
            frame = self.make(dim)[0]
            self.assertEqual([surface.name for surface in frame.surfaces], ["body"])
            self.assertEqual(frame.elements["body"].n_corners, dim + 1)

    def test_drops_are_no_surfaces_but_balls(self):
        for dim, axis in ((2, 2), (3, 1)):
            drops = [(1.1, .3, .2, .05), (1.9, .6, -.1, .1)]
            before, frame = self.make(dim, drops)
            self.assertEqual([len(before.points), len(frame.points)], [0, 1])
            self.assertEqual([surface.name for surface in frame.surfaces], ["body"])
            axes = plot_frame.pyplot.figure().add_subplot()
            plot_frame.draw_drops(axes, frame, axis)
            (circles,) = axes.collections
            for (x, y, z, radius), path in zip(drops, circles.get_paths()):
                seen = (x, y) if axis == 2 else (x, z)
                numpy.testing.assert_allclose(path.get_extents().get_points(), [[s - radius for s in seen], [s + radius for s in seen]],
                                              atol=1e-12)

    def test_tetrahedra_are_drawn_by_their_boundary(self):
        body = self.make(3)[0].elements["body"]
        self.assertEqual(plot_frame.boundary(body).shape, (4, 3, 3))
        # A second one on the side (0, 1, 3): its three other sides take the place of that one.
        vertices = numpy.vstack((body.vertices.read(), [(1.5, 0.1, 0.0)]))
        body.vertices = FixedArray(vertices)
        body.simplices = FixedArray(numpy.array([(0, 2, 1, 3), (0, 1, 4, 3)]))
        self.assertEqual(plot_frame.boundary(body).shape, (6, 3, 3))

    def test_lit_bodies_hide_their_far_side(self):
        # The two triangles of a cube nearest the viewer come last along each axis and cover the others.
        low, high = numpy.array((0.0, 0.0, 0.0)), numpy.array((1.0, 1.0, 1.0))
        vertices = numpy.array([[(low, high)[k >> a & 1][a] for a in range(3)] for k in range(8)])
        tetrahedra = numpy.array([(0, 1, 3, 7), (0, 3, 2, 7), (0, 2, 6, 7), (0, 6, 4, 7), (0, 4, 5, 7), (0, 5, 1, 7)])
        cube = self.make(3)[0].elements["body"]
        cube.vertices, cube.simplices = FixedArray(vertices), FixedArray(tetrahedra)
        for axis, nearest in ((0, 1.0), (1, 0.0), (2, 1.0)):
            corners = plot_frame.boundary(cube)
            triangles, colours, nearness = plot_frame.lit(cube, axis, (1.0, 0.5, 0.2), 1.0)
            order = numpy.argsort(nearness, kind="stable")
            triangles, colours = triangles[order], colours[order]
            self.assertEqual(triangles.shape, (12, 3, 2))
            keep = [i for i in range(3) if i != axis]
            front = corners[(corners[..., axis] == nearest).all(axis=1)][..., keep]
            self.assertEqual({triangle.tobytes() for triangle in triangles[-2:]},
                             {triangle.tobytes() for triangle in front})
            self.assertGreater(colours[-1][0], 0.8)     # it faces the viewer and the light

    def test_program(self):
        for dim in (2, 3):
            self.make(dim)
            result = self.run_tool("plot-frame")
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertGreater(imread(Path(self.folder.name) / "frame.png").std(), 0.1)

    def test_parts_of_a_movie_hold_its_frames(self):
        """ParaView is given a few frames of a run with many bodies at a time, each once, with all that is in them."""
        make_run.main(self.folder.name, 3)
        render, whole = load("render"), plot_frame.read_frames(self.folder.name)
        with unittest.mock.patch.object(sys, "argv", ["render", self.folder.name, "--movie"]):
            options = render.arguments()
        description = render.job(options)
        self.assertEqual(description["bounds"], [1, 2, 0, .75, -.25, .25])
        self.assertEqual(len(list(render.parts_of(description["frames"]))), 1)
        render.MOST_GRIDS = 1
        found = []
        for part in render.parts_of(description["frames"]):
            with tempfile.TemporaryDirectory() as where:
                render.index_of_a_part(self.folder.name, [frame["time"] for frame in part], where)
                for frame in plot_frame.read_frames(where):
                    found.append((frame.time, frame.names, float(frame["fluid"].values("smoke").sum())))
        self.assertEqual(found, [(frame.time, frame.names, float(frame["fluid"].values("smoke").sum())) for frame in whole])
        options.state = True
        with self.assertRaisesRegex(render.FramesError, "--state"):
            render.job(options)

    def test_messages(self):
        self.assertIn("holds no frames.xmf", self.run_tool("plot-frame").stderr)
        self.make(3)
        for arguments, message in [(["--field", "smok"], "the run wrote: smoke, velocity"),
                                   (["--frame", "7"], "frames 0 to 1"),
                                   (["--position", "9"], "outside the fluid's box"),
                                   (["--colours", "virids"], "no colour map 'virids'; near are viridis"),
                                   (["--output", "picture.jpg"], "says no format")]:
            result = self.run_tool("plot-frame", *arguments)
            self.assertEqual(result.returncode, 2)
            self.assertIn(message, result.stderr)


class Render(Pictures):
    def test_as_the_scene_wants_it(self):
        """From the front, and from 3 times as near: as many times as high, and a bit more for what is before the middle."""
        heights = []
        for zoom in (1, 3):
            make_run.main(self.folder.name, 3, view=f"""<ParameterList name="View">
                <Parameter name="Direction" value="{{0, 0, 1}}"/><Parameter name="Zoom" value="{zoom}"/>
                <Parameter name="Field" value="velocity"/></ParameterList>""")
            result = self.run_tool("render", "--size", "320x240")
            self.assertEqual(result.returncode, 0, result.stderr)
            picture = imread(Path(self.folder.name) / "render.png")[..., :3]
            # pixels outside of axes and colour bar
            red, green, blue = numpy.moveaxis(picture[:, 150:170], -1, 0)
            heights.append(numpy.ptp(numpy.nonzero((red > 0.2) & (green < 0.65 * red) & (blue < 0.65 * red))[0]))
        self.assertGreater(heights[0], 20)
        self.assertAlmostEqual(heights[1] / heights[0], 3.1, delta=0.35)

    def test_pictures(self):
        for dim, arguments in ((2, []), (3, []), (3, ["--volume", "--field", "smoke"]), (3, ["--field", "velocity"])):
            with self.subTest(dim=dim, arguments=arguments):
                self.make(dim)
                result = self.run_tool("render", "--size", "320x240", *arguments)
                self.assertEqual(result.returncode, 0, result.stderr)
                picture = imread(Path(self.folder.name) / "render.png")
                self.assertEqual(picture.shape[:2], (240, 320))
                # The scalar bar alone covers less than a tenth of the picture. Smoke is grey.
                coloured = numpy.ptp(picture[..., :3], axis=2) > 0.15
                seen = picture[..., :3].mean(axis=2) < 0.9 if "smoke" in arguments else coloured
                self.assertGreater(seen.mean(), 0.1)

    def test_a_cloud_of_smoke_fades_between_two_cells(self):
        # Smoke of 1 in the cells x < 1.5, which is the middle of the picture, of 0 in the others; they are 0.125 m long.
        make_run.main(self.folder.name, 3, view="""<ParameterList name="View">
            <Parameter name="Direction" value="{0, 0, 1}"/><Parameter name="Field" value="smoke"/>
            <Parameter name="Style" value="volume"/></ParameterList>""")
        with h5py.File(Path(self.folder.name) / "frames.h5", "r+") as file:
            for frame in file.values():
                frame["fluid/smoke"][...] = numpy.arange(8) < 4
        result = self.run_tool("render", "--size", "480x360")
        self.assertEqual(result.returncode, 0, result.stderr)
        picture = imread(Path(self.folder.name) / "render.png")[..., :3]
        self.assertLess(numpy.ptp(picture[:, 300:], axis=2).mean(), 0.01)    # smoke is grey, and has no bar of colours
        dark = 1 - picture.mean(axis=2)
        across = numpy.median(dark[60:80], axis=0)                         # within the box, above the body
        half_a_cell = 28
        self.assertGreater(across[140:240 - half_a_cell - 4].min(), 0.25)
        self.assertLess(across[240 + half_a_cell + 4:340].max(), 0.02)
        fading = across[240 - half_a_cell + 4:240 + half_a_cell - 4]
        self.assertLess(numpy.abs(numpy.diff(fading)).max(), 0.1)            # a block would end at once
        self.assertGreater(fading[0] - fading[-1], 0.15)

    def test_a_state_shows_the_same(self):
        self.make(3)
        folder = Path(self.folder.name)
        self.assertEqual(self.run_tool("render", "--state", "--size", "320x240").returncode, 0)
        script = folder / "again.py"
        script.write_text("from paraview import simple\n"
                          f"simple.LoadState({str(folder / 'render.pvsm')!r})\n"
                          f"simple.SaveScreenshot({str(folder / 'again.png')!r},\n"
                          "    simple.GetActiveViewOrCreate('RenderView'), ImageResolution=[320, 240])\n")
        with VirtualScreen(320, 240) as screen:
            done = subprocess.run(["pvbatch", script], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                                  env={**screen.environment, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"})
        self.assertEqual(done.returncode, 0)
        pictures = [imread(folder / name)[..., :3] for name in ("render.png", "again.png")]
        self.assertLess(numpy.abs(pictures[0] - pictures[1]).mean(), .01)

    def test_several_at_once(self):
        """Their screens do not meet, and none is gone when ParaView comes back to it."""
        self.make(2)
        pictures = [Path(self.folder.name) / f"{i}.png" for i in range(6)]
        running = [subprocess.Popen([TOOLS / "render", self.folder.name, "--size", "64x48", "--output", picture],
                                    stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) for picture in pictures]
        self.assertEqual([one.wait() for one in running], [0] * len(running))
        self.assertTrue(all(picture.is_file() for picture in pictures))

    def test_movie(self):
        self.make(3)
        result = self.run_tool("render", "--movie", "--size", "320x240")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertGreater((Path(self.folder.name) / "render.mp4").stat().st_size, 1000)

    def test_movie_by_matplotlib(self):
        """The frames have one size and one place, and differ in their colours."""
        self.make(2)
        result = self.run_tool("plot-frame", "--field", "velocity", "--movie")
        self.assertEqual(result.returncode, 0, result.stderr)
        folder = Path(self.folder.name)
        subprocess.run(["ffmpeg", "-loglevel", "error", "-i", folder / "frame.mp4", folder / "%d.png"], check=True)
        first, last = (imread(folder / f"{number}.png")[..., :3] for number in (1, 2))
        self.assertFalse((folder / "3.png").exists())
        below = first.shape[0] - 60                                        # the numbers of the axis
        self.assertLess(numpy.abs(first - last)[below:].mean(), 0.01)
        self.assertGreater(numpy.abs(first - last).mean(), 0.2)

    def test_parts_of_a_movie_show_the_same(self):
        """ParaView is given a few frames of a run with many bodies at a time: in the same colours, from the same place."""
        make_run.main(self.folder.name, 3)
        render, movies = load("render"), []
        with unittest.mock.patch.object(sys, "argv", ["render", self.folder.name, "--movie", "--size", "160x120"]):
            options = render.arguments()
        description = {**render.job(options), "state": ""}
        for render.MOST_GRIDS in (900, 1):
            with tempfile.TemporaryDirectory() as folder:
                movies.append([imread(picture)[..., :3] for picture in render.draw(options, dict(description), folder)])
        for whole, part in zip(*movies):
            self.assertEqual(numpy.abs(whole - part).max(), 0)
        self.assertGreater(numpy.abs(movies[0][0] - movies[0][1]).mean(), .01)

    def test_a_preview_shows_the_same(self):
        make_run.main(self.folder.name, 3)
        pictures = []
        for arguments in (["--size", "640x480"], ["--fast"]):
            result = self.run_tool("render", *arguments)
            self.assertEqual(result.returncode, 0, result.stderr)
            pictures.append(imread(Path(self.folder.name) / "render.png")[..., :3])
        self.assertEqual([picture.shape for picture in pictures], [(480, 640, 3)] * 2)
        self.assertLess(numpy.abs(pictures[0] - pictures[1]).mean(), 0.005)

    def test_a_preview_of_a_movie_has_few_frames_and_lasts_as_long(self):
        make_run.main(self.folder.name, 2)
        render = load("render")
        for most, times, rate in ((2, [0.0, 0.5], 25), (1, [0.0], 12.5)):
            render.MOST_PREVIEW_FRAMES = most
            with unittest.mock.patch.object(sys, "argv", ["render", self.folder.name, "--movie", "--fast"]):
                options = render.arguments()
            self.assertEqual(([one["time"] for one in render.job(options)["frames"]], options.rate), (times, rate))


if __name__ == "__main__":
    unittest.main()
