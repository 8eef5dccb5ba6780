"""Contents of tools/report's page of the folder of make_run.py and, given --simulate PROGRAM --scene FILE, of a real run."""
import base64
import json
import re
import subprocess
import sys
import tempfile
import unittest
import zlib
from pathlib import Path

import numpy

import make_run

TOOLS = Path(__file__).resolve().parents[2] / "tools"
sys.path.insert(0, str(TOOLS))
from lockstep_frames import read_frames  # noqa: E402 (the path comes first)
from run_parameters import view_of  # noqa: E402

PROGRAM = {}


def data_of(page):
    return json.loads(re.search(r'id="page-data">(.*?)</script>', page, re.DOTALL).group(1))


class Pages(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def report(self, *arguments):
        return subprocess.run([TOOLS / "report", *map(str, arguments)], text=True, stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE)

    def page(self, *arguments):
        path = self.folder / "page.html"
        result = self.report(*arguments, "--output", path)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        return path.read_text()

    def bytes_of(self, data, name):
        return zlib.decompress(base64.b64decode(data["blobs"][name]))

    def points(self, data, packed):
        """Decodes points as the page does, in other words: sums of 16-bit differences, within a box."""
        differences = numpy.frombuffer(self.bytes_of(data, packed["blob"]), "<u2").reshape(3, packed["n"])
        sums = numpy.cumsum(differences, axis=1, dtype="<u2").T
        return packed["low"] + sums / 65535 * packed["size"]

    def simplices(self, data, packed):
        return numpy.cumsum(numpy.frombuffer(self.bytes_of(data, packed["blob"]), "<u4"), dtype="<u4")

    def columns(self, data, table):
        values = numpy.frombuffer(self.bytes_of(data, table["blob"]), "<f4").reshape(len(table["columns"]), table["n"])
        return {column["name"]: row for column, row in zip(table["columns"], values)}

    def compare_frames(self, folder, data, run):
        frames = read_frames(folder)
        self.assertEqual(len(run["frames"]), len(frames))
        for frame, packed in zip(frames, run["frames"]):
            self.assertEqual(packed["time"], frame.time)
            self.assertEqual([surface["name"] for surface in packed["surfaces"]], [one.name for one in frame.surfaces])
            for surface, of in zip(packed["surfaces"], frame.surfaces):
                vertices = of.vertices.read()
                numpy.testing.assert_allclose(self.points(data, surface["points"]), vertices,
                                              atol=1e-5 * numpy.ptp(vertices))
                numpy.testing.assert_array_equal(self.simplices(data, surface["simplices"]), of.simplices.read().ravel())
            self.compare_fields(frame.boxes[0], data, packed)

    def compare_fields(self, box, data, packed):
        is_fluid = box.fields["fluid"][0].read().ravel() > 0 if "fluid" in box.fields else True
        self.assertEqual(set(packed["fields"]), set(box.fields) - {"fluid", "phi"})
        for name, field in packed["fields"].items():
            array, _, is_vector = box.fields[name]
            values = numpy.linalg.norm(array.read(), axis=-1) if is_vector else array.read()
            stored = numpy.frombuffer(self.bytes_of(data, field["blob"]), "u1").astype(float)
            numpy.testing.assert_array_equal(stored == 255, ~(is_fluid & (stored == stored)))
            found = numpy.where(stored == 255, numpy.nan, field["low"] + stored / 254 * (field["high"] - field["low"]))
            wanted = numpy.clip(values.ravel(), field["low"], field["high"])
            within = 0.51 / 254 * (field["high"] - field["low"])
            self.assertLessEqual(numpy.nanmax(numpy.abs(found - wanted)), within * 1.001)
            self.assertLess(numpy.mean(wanted != values.ravel()), 0.1)


class Data(Pages):
    def test_frames_and_tables(self):
        for dim in (2, 3):
            make_run.main(self.folder / "run", dim)
            data = data_of(self.page(self.folder / "run"))
            (run,) = data["runs"]
            self.compare_frames(self.folder / "run", data, run)
            history = self.columns(data, run["tables"]["history.csv"])
            numpy.testing.assert_allclose(history["fluid_kinetic_energy"], history["time"] ** 2, rtol=1e-6)
            units = [column["unit"] for column in run["tables"]["history.csv"]["columns"]]
            self.assertEqual(units, ["1", "s", "s", "1", "J"])
            body = self.columns(data, run["tables"]["bodies.csv"]["named"]["body"])
            numpy.testing.assert_allclose(body["x"], [1.42, 1.44, 1.46, 1.48, 1.5], rtol=1e-6)
            self.assertNotIn("z" if dim == 2 else "w", body)
            self.assertIn(["state", "done"], run["facts"])

    def test_tables_with_several_rows_a_time_are_told_apart_by_name(self):
        make_run.main(self.folder / "run", 3)
        # An observer of one's own may write such a table too, its names wherever they are, and call one as the page calls its own parts.
        (self.folder / "run" / "own.csv").write_text("name,time,force\ncolumns,0.1,5\nblob,0.1,7\ncolumns,0.2,6\n")
        data = data_of(self.page(self.folder / "run"))
        tables = data["runs"][0]["tables"]
        joints = {name: self.columns(data, table) for name, table in tables["joints.csv"]["named"].items()}
        self.assertEqual(list(joints), ["knee", "slide"])
        numpy.testing.assert_allclose(joints["knee"]["time"], [0.1, 0.2, 0.3, 0.4, 0.5], rtol=1e-6)
        numpy.testing.assert_allclose(joints["knee"]["q"], [0.3, 0.6, 0.9, 1.2, 1.5], rtol=1e-6)
        numpy.testing.assert_array_equal(joints["slide"]["q"], [-2] * 5)
        self.assertEqual(list(joints["slide"]), ["step", "time", "q", "at_limit"])
        own = tables["own.csv"]["named"]
        numpy.testing.assert_array_equal(self.columns(data, own["columns"])["force"], [5, 6])
        numpy.testing.assert_array_equal(self.columns(data, own["blob"])["force"], [7])

    def test_what_repeats_is_stored_once(self):
        make_run.main(self.folder / "run", 3)
        first, second = data_of(self.page(self.folder / "run"))["runs"][0]["frames"]
        self.assertEqual(first["surfaces"], second["surfaces"])

    def test_stands_alone(self):
        """Nothing is loaded from elsewhere, and what a scene says cannot end a script."""
        make_run.main(self.folder / "run", 3)
        page = self.page(self.folder / "run")
        self.assertIsNone(re.search(r"<(?:script|link|img|iframe)[^>]*\s(?:src|href)=", page))
        self.assertEqual(page.count("</script>"), page.count("<script"))
        self.assertIn("a </script> in a title", data_of(page)["runs"][0]["title"])

    def test_two_runs(self):
        make_run.main(self.folder / "a", 3)
        make_run.main(self.folder / "b", 3)
        path = self.folder / "b" / "used-parameters.xml"
        path.write_text(path.read_text().replace("-9.8", "-1.6"))
        data = data_of(self.page(self.folder / "a", self.folder / "b"))
        self.assertEqual(data["differences"], [["Fluid/Gravity", ["{0, -9.8, 0}", "{0, -1.6, 0}"]]])
        self.assertEqual([run["folder"] for run in data["runs"]], ["a", "b"])

    def test_how_a_scene_wants_to_be_shown(self):
        make_run.main(self.folder / "run", 3)
        (run,) = data_of(self.page(self.folder / "run"))["runs"]
        self.assertEqual(run["view"], {"up": 1, "direction": [0.45, 0.35, 1], "centre": None, "zoom": 1, "field": None,
                                       "volume": False, "time": None})
        values = {"Fluid/Gravity": "{0, 0, -9.8}", "View/Zoom": "2", "View/Center": "{1, 2, 3}", "View/Style": "volume",
                  "View/Time": "0.5", "View/Field": "smoke"}
        self.assertEqual(view_of(values), {"up": 2, "direction": [0.45, -1, 0.35], "centre": [1, 2, 3], "zoom": 2,
                                           "field": "smoke", "volume": True, "time": 0.5})

    def test_fewer_frames_and_fields(self):
        make_run.main(self.folder / "run", 3)
        (run,) = data_of(self.page(self.folder / "run", "--most-frames", 1, "--fields", "smoke"))["runs"]
        self.assertEqual([frame["time"] for frame in run["frames"]], [0.0, 0.5])  # the last is always there
        self.assertEqual((run["every"], run["n_written"]), (2, 2))
        self.assertEqual(list(run["frames"][0]["fields"]), ["smoke"])

    def test_layers_of_large_fields(self):
        from report_page import blobs, frames
        make_run.main(self.folder / "run", 3)
        limit, frames.MOST_FIELD_BYTES = frames.MOST_FIELD_BYTES, 8 * 6 * 4 * 2  # one field of two frames
        self.addCleanup(setattr, frames, "MOST_FIELD_BYTES", limit)
        store = blobs.Blobs()
        packed = frames.FramePacker(store, 10).pack(self.folder / "run")["frames"][1]
        self.assertIn("blob", packed["fields"]["smoke"])
        layers = packed["fields"]["velocity"]["layers"]
        self.assertEqual([[one["layer"] for one in of] for of in layers], [[2, 4, 6], [1, 3, 4], [1, 2, 3]])
        self.assertEqual(len(zlib.decompress(store[layers[1][0]["blob"]])), 8 * 4)

    def test_clouds_of_large_fields_are_coarse(self):
        from report_page import blobs, frames
        make_run.main(self.folder / "run", 3)
        for name, limit in (("MOST_FIELD_BYTES", 0), ("MOST_CLOUD_BYTES", 2 * 3 * 2 * 2)):  # every third cell along each axis
            self.addCleanup(setattr, frames, name, getattr(frames, name))
            setattr(frames, name, limit)
        store = blobs.Blobs()
        fields = frames.FramePacker(store, 10).pack(self.folder / "run")["frames"][1]["fields"]
        self.assertNotIn("volume", fields["velocity"])
        volume, low, high = (fields["smoke"][name] for name in ("volume", "low", "high"))
        self.assertEqual((volume["cells"], volume["by"]), ([3, 2, 2], 3))
        values = numpy.frombuffer(zlib.decompress(store[volume["blob"]]), "u1").reshape(2, 2, 3)
        # Smoke is x + 0.5 at the cells' centres; the last block has two cells of them.
        wanted = 1.5 + 0.125 * numpy.array((1.5, 4.5, 7.0))
        numpy.testing.assert_allclose(low + values / 254 * (high - low), numpy.broadcast_to(wanted, (2, 2, 3)), atol=0.005)

    def test_cells_without_values_do_not_count_in_a_coarse_cloud(self):
        from report_page.frames import coarsened
        values = numpy.array(((1.0, numpy.nan, 5.0), (3.0, 2.0, numpy.nan), (numpy.nan, numpy.nan, 7.0)))
        numpy.testing.assert_array_equal(coarsened(values, 2), ((2.0, 5.0), (numpy.nan, 7.0)))

    def test_complaints(self):
        (self.folder / "empty").mkdir()
        result = self.report(self.folder / "empty")
        self.assertEqual(result.returncode, 2)
        self.assertRegex(result.stderr, r"^report: .*empty is no output folder of a run")
        make_run.main(self.folder / "run", 2)
        (self.folder / "run" / "summary.json").write_text("{")
        self.assertRegex(self.report(self.folder / "run").stderr, "summary.json is not proper JSON")

    def test_no_frames_and_no_steps(self):
        make_run.main(self.folder / "run", 2)
        (self.folder / "run" / "frames.xmf").unlink()
        (self.folder / "run" / "history.csv").write_text("# time [s]: \nstep,time\n")
        (run,) = data_of(self.page(self.folder / "run"))["runs"]
        self.assertEqual(run["frames"], [])
        self.assertIn(["simulated time", "no step yet"], run["facts"])

    def test_a_fluid_with_a_domain_of_its_own(self):
        """Whose list may hold anything: the place of the player is that of what frames show."""
        folder = self.folder / "run"
        for dim in (2, 3):
            make_run.main(folder, dim)
            (wanted,) = data_of(self.page(folder))["runs"]
            file = folder / "used-parameters.xml"
            file.write_text(re.sub(r'(<ParameterList name="Domain">).*?(</ParameterList>)',
                                   r'\1<Parameter name="Length" type="double" value="2"/>\2', file.read_text(), count=1, flags=re.S))
            (run,) = data_of(self.page(folder))["runs"]
            numpy.testing.assert_allclose(run["domain"][0][:dim], wanted["domain"][0], rtol=1e-12)
            numpy.testing.assert_allclose(run["domain"][1][:dim], wanted["domain"][1], rtol=1e-12)
            self.assertNotIn("grid", dict(run["facts"]))
        (folder / "frames.xmf").unlink()
        (run,) = data_of(self.page(folder))["runs"]
        self.assertEqual(run["domain"], [[0, 0, 0], [1, 1, 1]])

    def test_real_run(self):
        if not PROGRAM:
            self.skipTest("no program was named")
        subprocess.run([PROGRAM["simulate"], PROGRAM["scene"], "--output", self.folder / "run", "--steps", "3", "--quiet",
                        "--set", "Domain/Cells={32, 32}", "--set", "Output/Frame Interval=0.001"], check=True)
        data = data_of(self.page(self.folder / "run"))
        (run,) = data["runs"]
        self.compare_frames(self.folder / "run", data, run)
        self.assertEqual(len(run["frames"]), 4)
        history = self.columns(data, run["tables"]["history.csv"])
        numpy.testing.assert_array_equal(history["step"], [1, 2, 3])
        # All columns that the page draws of a history, by the names of that time.
        wanted = re.findall(r'\["(\w+)", "[^"]*"\]', (TOOLS / "report_page" / "curves.js").read_text())
        self.assertEqual([name for name in wanted if name not in history], ["liquid_volume_target"])
        self.assertEqual(set(run["tables"]["bodies.csv"]["named"]), {"Disc", "Tail", "Curtain"})
        self.assertTrue(any(stage["name"] == "step / S2" for stage in run["stages"]))


if __name__ == "__main__":
    if "--simulate" in sys.argv:
        at = sys.argv.index("--simulate")
        PROGRAM.update(simulate=sys.argv[at + 1], scene=sys.argv[at + 3])
        del sys.argv[at:at + 4]
    unittest.main()
