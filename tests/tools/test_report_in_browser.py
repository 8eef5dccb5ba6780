"""The page of tools/report in a Chromium without windows and without network: it draws what it should where it should,
plays, and complains of nothing."""
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import matplotlib
import numpy
from matplotlib.image import imread

import make_run
from browser import Browser

TOOLS = Path(__file__).resolve().parents[2] / "tools"
READY = "document.body && document.body.dataset.ready === 'yes'"
BODY = numpy.array((0xcc, 0x5c, 0x40)) / 255  # the first of the solids' colours


class PageInBrowser(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = Path(folder.name)
        cls.browser = cls.enterClassContext(Browser()) if hasattr(cls, "enterClassContext") else Browser()

    def setUp(self):
        self.browser.complaints.clear()

    def open(self, *dims, view=""):
        folders = [self.folder / f"run-{dim}d" for dim in dims]
        for dim, folder in zip(dims, folders):
            make_run.main(folder, dim, view=view)
        page = self.folder / f"{len(dims)}-{dims[0]}.html"
        subprocess.run([TOOLS / "report", *folders, "--output", page], check=True, stdout=subprocess.DEVNULL)
        self.browser.open(page.as_uri())
        self.browser.wait_for(f"location.href === '{page.as_uri()}' && {READY}")

    def tearDown(self):
        self.assertEqual(self.browser.complaints, [])

    def player(self, number=0):
        """The pixels [row][column][3] of a player, as one sees them."""
        self.browser.run("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")
        self.browser.run("window.scrollTo(0, 0)")
        self.browser.picture(self.folder / "page.png")
        box = self.browser.run(f"(({{left, top, width, height}}) => [left, top, width, height])"
                               f"(document.querySelectorAll('.player canvas')[{number}].getBoundingClientRect())")
        left, top, width, height = (round(length) for length in box)
        picture = imread(self.folder / "page.png")[top:top + height, left:left + width, :3]
        self.assertGreater(min(picture.shape[:2]), 100)
        return picture

    def text(self, name):
        return self.browser.run(f"document.getElementById('{name}').textContent")

    def choose(self, name, value):
        self.browser.run(f"(() => {{ const of = document.getElementById('{name}'); of.value = '{value}';"
                         " of.dispatchEvent(new Event(of.type === 'range' ? 'input' : 'change')); })()")
        self.browser.run("new Promise((done) => setTimeout(done, 150))")

    def colour_at(self, picture, x, y):
        """In 2D: of the place (x, y) of the domain from (1, 0) to (2, 0.75), which fills the picture but for a rim."""
        height, width, _ = picture.shape
        half = 0.54 * max(0.75, 1.0 * height / width)  # half of the height that is seen [m]
        scale = height / (2 * half)
        return picture[round(height / 2 - (y - 0.375) * scale), round(width / 2 + (x - 1.5) * scale)]

    def test_colours_of_a_field_and_a_body_in_two_dimensions(self):
        self.open(2)
        picture = self.player()
        numpy.testing.assert_allclose(self.colour_at(picture, 1.32, 0.42), BODY, atol=0.02)
        # Smoke is x + t, in the range of both frames; a tenth of two frames is none, so it is the second's and the first's.
        viridis = matplotlib.colormaps["viridis"]
        for time in (0.0, 0.5):
            self.choose("scrub", int(time > 0))
            picture = self.player()
            for column in (0, 4, 7):
                x = 1.0 + (column + 0.5) * 0.125
                wanted = viridis((x + time - 1.0625) / (2.4375 - 1.0625))[:3]
                numpy.testing.assert_allclose(self.colour_at(picture, x, 0.69), wanted, atol=0.04)

    def test_without_field_and_solids_the_picture_is_empty(self):
        self.open(2)
        self.choose("field", "")
        self.assertGreater(numpy.ptp(self.player()[..., 0]), 0.2)
        self.browser.run("document.querySelectorAll('#toggles input').forEach((box) => { if (box.checked) box.click(); })")
        self.assertLess(numpy.ptp(self.player()[..., 0]), 0.2)  # the background alone

    def test_three_dimensions_turn(self):
        self.open(3)
        before = self.player()
        near_body = numpy.abs(before - BODY).max(axis=-1) < 0.35
        self.assertGreater(near_body.sum(), 200)
        for kind, x, y in (("mousePressed", 500, 500), ("mouseMoved", 560, 520), ("mouseReleased", 560, 520)):
            self.browser.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", buttons=1, clickCount=1)
        after = self.player()
        self.assertGreater(numpy.mean(numpy.abs(after - before).max(axis=-1) > 0.05), 0.02)
        self.browser.run("document.getElementById('home').click()")
        self.assertLess(numpy.abs(self.player() - before).mean(), 1e-3)

    def test_the_view_of_the_scene(self):
        """From the front and twice as near, with a field of its own."""
        seen = {}
        for zoom in (1, 2):
            self.open(3, view=f"""<ParameterList name="View"><Parameter name="Direction" value="{{0, 0, 1}}"/>
                <Parameter name="Zoom" value="{zoom}"/><Parameter name="Field" value="velocity"/></ParameterList>""")
            self.assertEqual(self.browser.run("document.getElementById('field').value"), "velocity")
            picture = self.player()
            is_body = numpy.abs(picture - BODY).max(axis=-1) < 0.35
            rows, columns = numpy.nonzero(is_body)
            seen[zoom] = len(rows)
            # The body's x are symmetric about the domain's middle.
            self.assertAlmostEqual(columns.mean() / picture.shape[1], 0.5, delta=0.02)
        self.assertGreater(seen[2] / seen[1], 3.5)

    def test_a_slice_moves(self):
        self.open(3)
        self.choose("style", "slice")
        self.choose("axis", "x")
        self.choose("layer", 0)
        before, place = self.player(), self.text("position")
        self.choose("layer", 7)
        self.assertEqual((place, self.text("position")), ("x = 1.063 m", "x = 1.938 m"))
        self.assertGreater(numpy.mean(numpy.abs(self.player() - before).max(axis=-1) > 0.05), 0.02)

    def toggle(self, *names):
        for name in names:
            self.browser.run(f"[...document.querySelectorAll('#toggles label')].find((label) => label.textContent === ' {name}').firstChild.click()")
        self.browser.run("new Promise((done) => setTimeout(done, 150))")

    def drawn(self):
        """Picture of the player: colours and opacity [row][column][4], from 0 to 1, and where its camera is."""
        width, height, numbers, camera = self.browser.run("""(() => {
            const player = state.players[0], from = player.renderer.domElement, to = document.createElement("canvas");
            [to.width, to.height] = [from.width, from.height];
            player.draw();
            to.getContext("2d").drawImage(from, 0, 0);
            const { position, fov, aspect } = player.camera;
            return [to.width, to.height, [...to.getContext("2d").getImageData(0, 0, to.width, to.height).data],
                    [position.x, position.y, position.z, fov, aspect]];
        })()""")
        return numpy.array(numbers).reshape(height, width, 4) / 255, camera

    def test_a_cloud_is_as_dense_as_its_field(self):
        """Opacity of pixels of a look from the front: 1 - exp(-22 * integral of the density / longest edge), by hand."""
        self.open(3, view="""<ParameterList name="View"><Parameter name="Direction" value="{0, 0, 1}"/></ParameterList>""")
        self.assertEqual(self.browser.run("document.getElementById('style').value"), "cloud")
        self.assertFalse(self.browser.run("document.getElementById('as').hidden"))
        self.toggle("solids", "paths", "box")
        picture, (*eye, field_of_view, aspect) = self.drawn()
        height, width = picture.shape[:2]
        seen = []
        for row, column in ((height // 2, width // 2), (height // 2, int(0.45 * width)), (int(0.4 * height), int(0.4 * width)), (5, 5)):
            up, right = 1 - 2 * (row + 0.5) / height, 2 * (column + 0.5) / width - 1
            slope = numpy.tan(numpy.radians(field_of_view / 2))
            ray = numpy.array((right * slope * aspect, up * slope, -1.0))
            low, high = numpy.array((1, 0, -0.25)), numpy.array((2, 0.75, 0.25))
            ray = numpy.where(ray == 0, 1e-12, ray)
            ends = numpy.sort(numpy.array(((low - eye) / ray, (high - eye) / ray)), axis=0)
            begin, end = ends[0].max(), max(ends[1].min(), ends[0].max())
            x = eye[0] + (begin + (end - begin) * (numpy.arange(2000) + 0.5) / 2000) * ray[0]
            density = (numpy.clip(x, 1.0625, 1.9375) - 1.0625) / (2.4375 - 1.0625)
            wanted = 1 - numpy.exp(-22 * density.mean() * (end - begin) * numpy.linalg.norm(ray))
            seen.append(wanted)
            self.assertAlmostEqual(picture[row, column, 3], wanted, delta=0.02, msg=(row, column))
        self.assertGreater(numpy.ptp(seen[:3]), 0.1)
        self.assertEqual(seen[3], 0)
        self.choose("style", "slice")
        self.assertFalse(self.browser.run("state.players[0].cloud.mesh.visible"))
        self.assertFalse(self.browser.run("document.querySelector('.of-slice').hidden"))

    def test_a_cloud_ends_at_what_is_opaque(self):
        """The body's tip, with 0.05 m of density 0.32 before it and 0.4 behind, keeps exp(-0.35) of its colour."""
        self.open(3, view="""<ParameterList name="View"><Parameter name="Direction" value="{0, 0, 1}"/></ParameterList>""")
        self.toggle("paths", "box")
        with_cloud, (*eye, field_of_view, aspect) = self.drawn()
        self.choose("field", "")
        alone = self.drawn()[0]
        height, width = alone.shape[:2]
        ray = numpy.array((1.5, 0.4, 0.2)) - eye
        scale = height / 2 / numpy.tan(numpy.radians(field_of_view / 2)) / -ray[2]
        row, column = int(height / 2 - ray[1] * scale), int(width / 2 + ray[0] * scale)
        redness = [(picture[..., 0] - picture[..., 2])[row - 2:row + 3, column - 2:column + 3].mean() for picture in (with_cloud, alone)]
        self.assertGreater(redness[1], 0.3)
        self.assertAlmostEqual(redness[0] / redness[1], numpy.exp(-0.35), delta=0.12)

    def test_only_clouds_are_offered_as_such(self):
        self.open(3)
        self.choose("field", "velocity")
        self.assertTrue(self.browser.run("document.getElementById('as').hidden"))
        self.open(2)
        self.assertTrue(self.browser.run("document.getElementById('as').hidden"))

    def test_plays_to_the_end(self):
        self.open(3)
        self.assertIn("frame 1 of 2", self.text("clock"))
        before = self.player()
        self.choose("speed", self.browser.run("document.getElementById('speed').lastChild.value"))
        self.browser.run("document.getElementById('play').click()")
        self.browser.wait_for("!state.playing", 30)
        self.assertEqual(self.text("clock"), "t = 0.5 s, frame 2 of 2")
        self.assertGreater(numpy.abs(self.player() - before).max(), 0.05)

    def test_curves(self):
        self.open(2)
        titles = self.browser.run("[...document.querySelectorAll('.plot')].map((plot) => plot.dataset.title)")
        self.assertEqual(titles, ["Energy", "Iterations", "Time step", "Bodies", "Joints"])
        # The energy is t squared: half way up at 1 / sqrt(2) of the time, as drawn.
        path = self.browser.run("document.querySelector('.plot .curve').getAttribute('d')")
        points = [tuple(map(float, pair)) for pair in re.findall(r"[ML]([\d.]+) ([\d.]+)", path)]
        heights = [points[0][1] - y for _, y in points]
        times = numpy.arange(1, 6) * 0.1
        numpy.testing.assert_allclose(numpy.array(heights) / heights[-1], (times ** 2 - 0.01) / 0.24, atol=2e-3)
        self.choose("scrub", 1)
        values = self.browser.run("[...document.querySelectorAll('.plot .value')].map((value) => value.textContent)")
        self.assertEqual(values, ["0.25", "5", "0.1", "1.5", "1.6", "1.5", "-2"])
        # A curve for each joint, not one that jumps from one to the other: times only grow along it.
        paths = self.browser.run("[...document.querySelectorAll('[data-title=Joints] .curve')].map((path) => path.getAttribute('d'))")
        of_knee, of_slide = ([tuple(map(float, pair)) for pair in re.findall(r"[ML]([\d.]+) ([\d.]+)", path)] for path in paths)
        self.assertEqual([len(of_knee), len({y for _, y in of_knee}), len({y for _, y in of_slide})], [5, 5, 1])
        choices = self.browser.run("[...document.querySelectorAll('[data-title=Joints] option')].map((option) => option.textContent)")
        self.assertEqual(choices, ["q [rad, m]", "at_limit"])
        self.browser.run("document.querySelector('[data-title=Bodies] .legend button').click()")
        self.assertEqual(self.browser.run("document.querySelectorAll('[data-title=Bodies] .curve').length"), 1)

    def test_two_runs(self):
        self.open(3, 3)
        for number in (0, 1):
            self.assertGreater(numpy.ptp(self.player(number)[..., 0]), 0.2)
        self.assertEqual(self.browser.run("document.querySelectorAll('[data-title=Energy] .curve').length"), 2)

    def test_watched_page_follows_the_run(self):
        folder = self.folder / "watched"
        make_run.main(folder, 2)
        watcher = subprocess.Popen([TOOLS / "watch", folder, "--port", "0", "--every", "0.2"], stdout=subprocess.PIPE, text=True)
        try:
            self.browser.open(watcher.stdout.readline().strip())
            self.browser.wait_for(f"location.protocol === 'http:' && {READY}")
            self.assertEqual(self.text("clock"), "t = 0.5 s, frame 2 of 2")  # a watched run is shown at its end
            self.assertGreater(numpy.abs(self.player() - BODY).max(axis=-1).ptp(), 0.3)
            self.choose("field", "velocity")
            (folder / "history.csv").write_text(make_run.history() + "6,0.6,0.1,60,0.36\n")
            (folder / "summary.json").write_text('{"status": "failed", "message": "no way out"}')
            self.browser.wait_for("document.querySelector('.state').textContent === 'failed: no way out'", 20)
            self.assertEqual(self.text("clock"), "t = 0.5 s, frame 2 of 2")
            iterations = "document.querySelector('[data-title=Iterations] .curve').getAttribute('d').match(/[ML]/g).length"
            self.browser.wait_for(f"{iterations} === 6", 20)
            self.assertEqual(self.browser.run("document.getElementById('field').value"), "velocity")
            self.assertEqual(self.browser.complaints, [])
        finally:
            watcher.kill()
            watcher.wait()
            watcher.stdout.close()
        self.browser.wait_for("Boolean(document.getElementById('complaint'))", 20)
        self.browser.open("about:blank")
        self.browser.wait_for("location.protocol === 'about:'")
        self.browser.complaints.clear()  # drops the complaint that the connection was refused

    def test_what_a_scene_says_is_text(self):
        self.open(2)
        self.assertEqual(self.browser.run("document.querySelector('h1').textContent"), "a </script> in a title")
        self.assertIn("the scene of a </script>", self.browser.run("document.querySelector('pre').textContent"))


if __name__ == "__main__":
    unittest.main()
