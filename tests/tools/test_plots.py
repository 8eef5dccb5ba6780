"""plot-study, plot-curves and plot-solvers: names with units, legends that hide nothing, ticks that one can read, files, broken tables."""
import contextlib
import importlib.machinery
import importlib.util
import io
import itertools
import re
import subprocess
import sys
import tempfile
import unittest
import unittest.mock
import xml.etree.ElementTree
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
TOOLS = ROOT / "tools"
sys.path.insert(0, str(TOOLS))
import plot_style  # noqa: E402 (the path comes first)


def load(name):
    """A program of tools/ as a module."""
    loader = importlib.machinery.SourceFileLoader(name.replace("-", "_"), str(TOOLS / name))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader(loader.name, loader))
    loader.exec_module(module)
    return module


plot_study, plot_curves, plot_solvers = load("plot-study"), load("plot-curves"), load("plot-solvers")
COLUMNS = "series,quantity,value,reference,error,core_seconds,spread,abscissa"
HEAD = """# title: Made up, with a title that is so long that it does not fit above a picture of one or two columns unless it is broken
# abscissa: h
# ladder: n
# unit of speed; largest: m/s
# unit of lost volume: 1
# unit of height: m
# unit of drops: 1
# reference of height: self
# targets of speed; largest: 0.1 0.01
"""


def table(names, head=HEAD):
    """Errors of first order, a value that ought to be 0, one against the finest run, and one without reference, that is 0 at times."""
    lines = [head + COLUMNS]
    for number, name in enumerate(names):
        for k in range(4):
            h, cost = 0.1 / 2 ** k, 0.3 * 3 ** k + 0.01 * number
            lines += [f"{name},speed; largest,{2 + h * (number + 1)},2,{h * (number + 1) / 2},{cost},0,{h}",
                      f"{name},lost volume,{-h * (number + 1)},0,{h * (number + 1)},{cost},0,{h}",
                      f"{name},height,{3 + h},{3 if k < 3 else ''},{h / 3 if k < 3 else ''},{cost},0,{h}",
                      f"{name},drops,{number * 10 ** k},,,{cost},0.5,{h}"]
    return "\n".join(lines) + "\n"


def curves():
    rows = [f"level,{series},{n},{time},{n * time},{n if series == 'free' else ''}"
            for series in ("free", "held; long name of a series") for n in (8, 16, 32) for time in (0, 0.5, 1)]
    return "# title: Levels\n# ladder: n\n# unit of level: m\ncurve,series,ladder,time,value,exact\n" + "\n".join(rows) + "\n"


class Plots(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.addCleanup(plot_style.pyplot.close, "all")
        self.folder = Path(folder.name)

    def write(self, text):
        path = self.folder / "table.csv"
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return path

    def study(self, path):
        return plot_study.figure_of(*plot_study.read_table(path, ("series", "quantity"), plot_study.NUMBERS))

    def curves(self, path):
        return plot_curves.figure_of(*plot_curves.read_table(path, ("curve", "series"), ("ladder", "time", "value", "exact")))

    def run_tool(self, tool, *words):
        """Exit code and what is told."""
        told = io.StringIO()
        with unittest.mock.patch.object(sys, "argv", ["tool", *map(str, words)]), contextlib.redirect_stderr(told):
            return tool.main(), told.getvalue()


class Axes(Plots):
    def check(self, figure):
        figure.canvas.draw()
        renderer, whole = figure.canvas.get_renderer(), figure.bbox.padded(1)
        shown = [axes for axes in figure.axes if axes.axison]
        self.assertTrue(shown)
        for axes in shown:
            names = [axes.get_xlabel()] + ([axes.get_ylabel()] if axes.get_subplotspec().is_first_col() or axes.get_ylabel() else [])
            for name in names:
                self.assertRegex(name, r"(?s)\S.*\[.+\]$|\S.*\(dimensionless\)$|^number of ")
            for axis in (axes.xaxis, axes.yaxis):
                texts = [text for text in axis.get_ticklabels() if text.get_visible() and text.get_text()]
                low, high = sorted(axis.get_view_interval())
                boxes = [text.get_window_extent(renderer) for text, place in zip(texts, axis.get_ticklocs()) if low <= place <= high]
                for one, other in itertools.combinations(boxes, 2):
                    self.assertFalse(one.overlaps(other), [text.get_text() for text in texts])
                self.assertTrue(contains(whole, axis.label.get_window_extent(renderer)), axis.label.get_text())
        for legend in [axes.get_legend() for axes in figure.axes if axes.get_legend()]:
            box = legend.get_window_extent(renderer)
            self.assertTrue(contains(whole, box))
            for axes in shown:
                self.assertFalse(box.overlaps(axes.get_window_extent(renderer)))
        title = figure._suptitle.get_window_extent(renderer)
        self.assertTrue(contains(whole, title))
        self.assertFalse(any(title.overlaps(axes.get_window_extent(renderer)) for axes in shown))

    def test_a_study(self):
        figure = self.study(self.write(table(["flux; order 1", "flux; order 2", "voxel"])))
        self.check(figure)
        labels = [axes.get_ylabel().replace("\n", " ") for axes in figure.axes[::2]]
        self.assertEqual(labels, ["relative error of speed, largest (dimensionless)", "|lost volume| (dimensionless)",
                                  "relative error of height against the finest run (dimensionless)", "drops (dimensionless)"])
        self.assertEqual([axes.axison for axes in figure.axes], [True] * 7 + [False])  # no question asks what drops cost
        self.assertEqual({axes.get_xlabel() for axes in figure.axes[::2]}, {"cell size h [m]"})
        legend = [text.get_text() for text in figure.axes[1].get_legend().get_texts()]
        self.assertEqual(legend, ["flux, order 1", "flux, order 2", "voxel", "order 1", "order 2"])
        self.assertEqual(figure.axes[-2].get_yscale(), "symlog")

    def test_many_series_stand_in_families(self):
        names = [f"{family}; E {k}" for family in ("disc", "ball", "cloth of a long name") for k in range(9)]
        figure = self.study(self.write(table(names)))
        self.check(figure)
        self.assertEqual(len(figure.axes), 3 * 4)
        self.check(self.study(self.write(table([f"number {k}" for k in range(60)]))))

    def test_ladders_of_no_resolution(self):
        head = "# abscissa: ratio\n# ladder: ratio\n# abscissa name: density over that of the fluid\n# abscissa unit: 1\n"
        figure = self.study(self.write(table(["all"], head + HEAD.split("\n", 3)[3])))
        self.assertEqual(len(figure.axes), 4)
        self.assertEqual(figure.axes[0].get_xlabel(), "density over that of the fluid\n(dimensionless)")
        self.assertFalse(any(axes.get_legend() for axes in figure.axes))  # one line needs none

    def test_absolute_errors_have_the_unit(self):
        rows = table(["all"]).replace("height", "angle").splitlines()
        rows = [re.sub(r"^(all,speed; largest,)([\d.e-]+),2,[\d.e-]+", lambda m: f"{m[1]}{m[2]},2,{float(m[2]) - 2}", row) for row in rows]
        figure = self.study(self.write("\n".join(rows)))
        self.assertEqual(figure.axes[0].get_ylabel(), "error of speed, largest [m/s]")

    def test_studies_of_this_tree(self):
        for name in ("contact-stability", "dam-break-box", "mesh-ratio"):
            with self.subTest(study=name):
                self.check(self.study(ROOT / f"docs/results/{name}.csv"))

    def test_curves(self):
        figure = self.curves(self.write(curves()))
        self.check(figure)
        self.assertEqual(figure.axes[0].get_ylabel(), "level [m]")
        (legend,) = [axes.get_legend() for axes in figure.axes if axes.get_legend()]
        self.assertEqual([text.get_text() for text in legend.get_texts()], ["n = 8", "n = 16", "n = 32", "reference"])

    def test_ticks(self):
        self.assertEqual(plot_style.log_ticks(0.03, 40), [0.1, 1, 10])
        self.assertEqual(plot_style.log_ticks(1e-16, 1e4), [1e-15, 1e-12, 1e-9, 1e-6, 1e-3, 1, 1000])
        self.assertEqual(plot_style.log_ticks(0.0078, 0.07), [0.01, 0.02, 0.05])
        self.assertEqual(plot_style.log_ticks(1.1, 4.2), [1.5, 2, 3, 4])
        self.assertEqual([round(place, 3) for place in plot_style.log_ticks(0.108, 0.125)], [0.11, 0.115, 0.12, 0.125])
        self.assertEqual([plot_style.tick_text(value, False) for value in (1e-5, 2e-5, 0)], ["$10^{-5}$", r"$2\times10^{-5}$", "0"])

    def test_series_differ(self):
        styles = [tuple(map(str, plot_style.series_style(number).values())) for number in range(90)]
        self.assertEqual(len(set(styles)), 90)


def contains(whole, box):
    return whole.x0 <= box.x0 and box.x1 <= whole.x1 and whole.y0 <= box.y0 and box.y1 <= whole.y1


class Units(unittest.TestCase):
    def test_studies_name_the_units_of_all_that_they_plot(self):
        for file in sorted((ROOT / "xml-params/studies").glob("*.xml")):
            study = xml.etree.ElementTree.parse(file).getroot()
            if study.get("name") != "Study":
                continue
            ladder = {one.get("name"): one.get("value") for one in study.find("ParameterList[@name='Ladder']")}
            if ladder.get("Abscissa", "h") not in plot_study.ABSCISSAS:
                self.assertLessEqual({"Title", "Unit"}, ladder.keys(), file.name)
            for one in study.findall("ParameterList[@name='Quantities']/*") + study.findall("ParameterList[@name='Curves']/*"):
                with self.subTest(study=file.name, quantity=one.get("name")):
                    self.assertIsNotNone(one.find("Parameter[@name='Unit']"))

    def test_tables_of_results_have_them(self):
        n_tables = 0
        for file in sorted((ROOT / "docs/results").glob("*.csv")):
            if "# abscissa: " not in file.read_text():
                continue
            header, rows = plot_study.read_table(file, ("series", "quantity"), plot_study.NUMBERS)
            n_tables += 1
            for quantity in {row["quantity"] for row in rows}:
                with self.subTest(table=file.name, quantity=quantity):
                    self.assertTrue(header.get(f"unit of {quantity}"))
            self.assertRegex(plot_study.label_of_abscissa(header), r"(?s)\]$|\(dimensionless\)$|^number of ")
        self.assertGreater(n_tables, 70)


class Files(Plots):
    def test_formats(self):
        path = self.write(table(["flux", "voxel"]))
        done = subprocess.run([TOOLS / "plot-study", path, self.folder / "fig.3", "--format", "png,pdf,svg"], stderr=subprocess.PIPE, text=True)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        for suffix, start in (("png", b"\x89PNG"), ("pdf", b"%PDF"), ("svg", b"<?xml")):
            self.assertTrue((self.folder / f"fig.3.{suffix}").read_bytes().startswith(start))
        self.assertLess((self.folder / "fig.3.png").stat().st_size, plot_style.LARGEST_PNG)
        self.assertNotIn(b"/Type3", (self.folder / "fig.3.pdf").read_bytes())  # journals refuse it
        self.assertEqual(self.run_tool(plot_curves, self.write(curves()), self.folder / "curves.svg"), (0, ""))
        self.assertIn("</svg>", (self.folder / "curves.svg").read_text())

    def test_histories_of_solvers_fall_from_their_first_solve(self):
        """In any order of the rows; a list whose solves have no error is in the picture of residuals alone."""
        head = "file,strategy,tolerance,iterations,setup_seconds,solve_seconds,pressure_residual,solid_residual,error\n"
        rows = [f"lists/{name}.xml,cg,{10.0 ** -k},{3 * k},0.5,{k},{10.0 ** -k / 2},{10.0 ** -k / 3},{'' if name == 'b' else 10.0 ** -k}\n"
                for name in "ab" for k in (3, 1, 2)]
        figure = plot_solvers.figure_of(plot_solvers.read_table(self.write(head + "".join(rows)), ["file"], plot_solvers.NUMBERS)[1])
        residuals, _, errors, _ = figure.axes
        self.assertEqual([text.get_text() for text in figure.axes[1].get_legend().get_texts()], ["a", "b"])
        for line in residuals.lines:
            self.assertEqual(list(line.get_xdata()), [3, 6, 9])
            self.assertEqual(list(line.get_ydata()), [.05, .005, .0005])
        self.assertEqual([len(line.get_xdata()) for line in errors.lines], [3, 0])
        self.assertEqual(list(figure.axes[1].lines[0].get_xdata()), [1.5, 2.5, 3.5])
        code, told = self.run_tool(plot_solvers, self.write("file,iterations\na,1\n"), self.folder / "picture.png")
        self.assertEqual(code, 2)
        self.assertIn("has no column 'tolerance'", told)

    def test_a_large_picture_gets_fewer_dots(self):
        figure = self.study(self.write(table(["flux", "voxel"])))
        with unittest.mock.patch.object(plot_style, "LARGEST_PNG", 30_000):
            plot_style.save(figure, [self.folder / "small.png"])
        self.assertLess((self.folder / "small.png").stat().st_size, 30_000)

    def test_colours_of_lines_are_kept(self):
        picture = self.folder / "picture.png"
        plot_style.save(self.study(self.write(table([f"number {k}" for k in range(10)]))), [picture])
        pixels = set(plot_style.Image.open(picture).convert("RGB").getdata())
        for number in range(10):
            colour = [round(255 * part) for part in plot_style.matplotlib.colors.to_rgb(f"C{number}")]
            self.assertLess(min(sum(abs(a - b) for a, b in zip(colour, pixel)) for pixel in pixels), 20, number)

    def test_what_is_wrong_is_told_in_a_sentence(self):
        good, picture = table(["flux"]), self.folder / "picture.png"
        broken = {"no column 'value'": good.replace(",value,", ",valeu,"), "holds no rows": "".join(good.splitlines(True)[:10]),
                  "'abc' is no number": good.replace("2.1,2", "abc,2", 1), "has 3 columns, not 8": good + "flux,speed,1\n",
                  "is no text file": b"\xff\xfe\x00", "holds no number": HEAD + COLUMNS + "\nflux,speed,nan,,,1,0,1\n"}
        for sentence, text in broken.items():
            with self.subTest(sentence=sentence):
                code, told = self.run_tool(plot_study, self.write(text), picture)
                self.assertEqual((code, told.count("\n")), (2, 1))
                self.assertIn(sentence, told)
        path = self.write(good)
        for words, sentence in (([self.folder / "none.csv", picture], "cannot be read: No such file"), ([path, self.folder / "picture.jpg"], "says no format"),
                                ([path, picture, "--format", "png,gif"], "knows no 'gif'"), ([path, self.folder / "no/picture.pdf"], "cannot be written")):
            code, told = self.run_tool(plot_study, *words)
            self.assertEqual((code, told.count("\n")), (2, 1))
            self.assertIn(sentence, told)
        self.assertEqual(self.run_tool(plot_curves, path, picture)[0], 2)
        self.assertFalse(picture.exists())


if __name__ == "__main__":
    unittest.main()
