"""The common part of the plots of tools/: how tables are read, names with units on axes, ticks, legends beside the axes, files."""
import csv
import io
import math
import textwrap
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
from matplotlib import pyplot, ticker  # noqa: E402 (the backend comes first)
from PIL import Image  # noqa: E402

SUFFIXES = ("png", "pdf", "svg")
LARGEST_PNG = 300_000  # bytes
DOTS = 110             # an inch
MARKERS = "osD^v<>ph"  # as many as have no divisor in common with the ten colours: 90 pairs
LINES = ["-", "-.", (0, (1, 1))]  # the next one once the ten colours are used up
MOST_IN_LEGEND = 24    # entries of one column of a legend

pyplot.rcParams.update({
    "font.size": 9, "axes.titlesize": 9, "axes.labelsize": 9, "xtick.labelsize": 8, "ytick.labelsize": 8, "legend.fontsize": 7.5,
    "figure.titlesize": 10, "grid.linewidth": 0.3, "lines.linewidth": 1,
    "lines.markersize": 4.5, "axes.formatter.useoffset": False, "axes.formatter.use_mathtext": True, "axes.formatter.limits": (-3, 5),
    # Journals want fonts in the file; the same table gives the same file.
    "pdf.fonttype": 42, "svg.hashsalt": "lockstep"})


class PlotError(Exception):
    """A sentence for the user."""


def lines_of(path):
    """The lines of a text file, or a sentence why not."""
    try:
        return Path(path).read_text().splitlines()
    except OSError as error:
        raise PlotError(f"'{path}' cannot be read: {error.strerror}.") from error
    except UnicodeDecodeError as error:
        raise PlotError(f"'{path}' is no text file.") from error


def read_table(path, names, numbers):
    """The header "# name: text" of a CSV file as a dictionary, and its rows; numbers that are missing are None."""
    header, rows, columns = {}, [], None
    for number, line in enumerate(lines_of(path), 1):
        if line.startswith("#"):
            name, _, text = line[1:].strip().partition(": ")
            header[name] = text
        elif columns is None and line:
            columns = next(csv.reader([line]))
            for missing in [name for name in (*names, *numbers) if name not in columns]:
                raise PlotError(f"'{path}' has no column '{missing}'.")
        elif line:
            row = dict(zip(columns, next(csv.reader([line]))))
            if len(row) != len(columns):
                raise PlotError(f"Line {number} of '{path}' has {len(row)} columns, not {len(columns)}.")
            for name in numbers:
                row[name] = number_of(row[name], f"Line {number} of '{path}', column '{name}'")
            rows.append(row)
    if not rows:
        raise PlotError(f"'{path}' holds no rows.")
    return header, rows


def number_of(text, where):
    try:
        return float(text) if text else None
    except ValueError as error:
        raise PlotError(f"{where}: '{text}' is no number.") from error


def groups(rows, name):
    """Rows by the value of a column, in order of appearance."""
    result = {}
    for row in rows:
        result.setdefault(row[name], []).append(row)
    return result


def plain(name):
    """A name as its study has it: in CSV files ';' stands for ','."""
    return name.replace(";", ",")


def label(name, unit, width=44):
    """A name with its unit, or that it has no dimension; names that end in brackets and numbers say it. Lines of at most `width`."""
    name = plain(name)
    if unit and not name.endswith("]") and not name.startswith("number of"):
        name += " (dimensionless)" if unit == "1" else f" [{unit}]"
    return "\n".join(textwrap.wrap(name, width, break_long_words=False))


def panels(n_rows, n_columns, **options):
    """A figure and its axes [row][column], in which nothing overlaps."""
    figure, all_axes = pyplot.subplots(n_rows, n_columns, squeeze=False, layout="constrained", **options)
    for axes in all_axes.flat:
        axes.grid(True)
    return figure, all_axes


def series_style(number):
    """Colour, marker and line of a series, no two of 90 alike; hollow, so that one sees what lies beneath."""
    return {"color": f"C{number % 10}", "marker": MARKERS[number % len(MARKERS)], "markerfacecolor": "none",
            "linestyle": LINES[number // 10 % len(LINES)]}


def set_scales(axes, xs, ys):
    """Logarithmic where all is positive and spans a factor, or spans decades beside 0. Call it when all is drawn."""
    for values, axis, set_scale in ((xs, axes.xaxis, axes.set_xscale), (ys, axes.yaxis, axes.set_yscale)):
        least, most = min((value for value in values if value > 0), default=0), max(values, default=0)
        if values and min(values) >= 0 and least > 0 and most > (1.5 if min(values) > 0 else 100) * least:
            if min(values) > 0:
                set_scale("log")
                set_log_ticks(axis, *axis.get_view_interval())
            else:  # 0 lies a decade below the least
                set_scale("symlog", linthresh=least, linscale=0.9)
                axis.set_view_interval(-0.1 * least, 2 * most, ignore=True)
                set_log_ticks(axis, least, 2 * most, [0])
            continue
        if values and max(values) - min(values) <= 1e-9 * max(map(abs, values)):  # one value: else its digits after the tenth
            middle, reach = values[0], 0.1 * abs(values[0]) or 1.0
            axes.set(**{f"{axis.axis_name}lim": (middle - reach, middle + reach)})
        axis.set_major_locator(ticker.MaxNLocator(6, steps=[1, 2, 5, 10], integer=all(value == int(value) for value in values)))


def log_ticks(low, high):
    """Places of at least three ticks where there are any: decades, or some of them; else 1, 2, 5; else more of a decade; else even steps."""
    first, last = math.floor(math.log10(low)), math.ceil(math.log10(high))
    every = -(-(last - first) // 7)
    decades = [10.0 ** k for k in range(first, last + 1) if k % every == 0]
    for factors in ((1,), (1, 2, 5), (1, 1.5, 2, 3, 4, 6, 8)):
        places = [factor * decade for decade in decades for factor in factors]
        places = [place for place in places if low <= place <= high]
        if len(places) >= 3:
            return places
    return [place for place in ticker.MaxNLocator(4, steps=[1, 2, 2.5, 5, 10]).tick_values(low, high) if low <= place <= high]


def tick_text(value, is_plain):
    if is_plain or value == 0:
        return f"{value:.6g}"
    mantissa, exponent = f"{value:.5e}".split("e")
    mantissa = f"{float(mantissa):g}"
    return rf"$10^{{{int(exponent)}}}$" if mantissa == "1" else rf"${mantissa}\times10^{{{int(exponent)}}}$"


def set_log_ticks(axis, low, high, more=()):
    """Ticks that one can read between two places and at some more, labelled by as many figures as they need."""
    view, places = axis.get_view_interval(), [*more, *log_ticks(low, high)]
    is_plain = all(1e-3 <= place < 1e5 for place in places if place)
    axis.set_view_interval(*view, ignore=True)
    axis.set_major_locator(ticker.FixedLocator(places))
    axis.set_major_formatter(ticker.FuncFormatter(lambda value, _: tick_text(value, is_plain)))
    axis.set_minor_locator(ticker.LogLocator(subs=range(1, 10), numticks=99) if high < 1e5 * low and not more else ticker.NullLocator())
    axis.set_minor_formatter(ticker.NullFormatter())


def legend_beside(axes, handles_by_name, place=1.02):
    """A legend to the right of the axes, or at another place in widths of them. Returns the width that it takes [inches]."""
    names, handles = list(handles_by_name), list(handles_by_name.values())
    if not names:
        return 0.0
    n_columns = -(-len(names) // MOST_IN_LEGEND)
    axes.legend(handles, names, loc="upper left", bbox_to_anchor=(place, 1.0), borderaxespad=0.0, ncol=n_columns)
    return n_columns * (0.55 + 0.055 * max(map(len, names)))


def set_title(figure, text):
    """Above all, in lines as long as the figure is wide."""
    figure.suptitle("\n".join(textwrap.wrap(text, int(13 * figure.get_figwidth()))))


def outputs_of(picture, formats):
    """The files to write: the picture as its suffix says, or one for each of the formats "png,pdf,svg"."""
    picture = Path(picture)
    if not formats:
        if picture.suffix[1:].lower() not in SUFFIXES:
            raise PlotError(f"'{picture}' says no format: let it end in .png, .pdf or .svg, or name some by --format png,pdf,svg.")
        return [picture]
    unknown = [one for one in formats.split(",") if one not in SUFFIXES]
    if unknown:
        raise PlotError(f"--format knows no '{unknown[0]}'; there are png, pdf and svg, with commas between.")
    # "fig.3" has no suffix to be replaced.
    stem = picture.with_suffix("") if picture.suffix[1:].lower() in SUFFIXES else picture
    return [stem.with_name(f"{stem.name}.{one}") for one in formats.split(",")]


def save(figure, outputs, dots=DOTS, is_lines=True, **options):
    """Writes the figure to each file; a PNG with as few colours and dots as keep it below LARGEST_PNG."""
    for output in outputs:
        try:
            if output.suffix.lower() == ".png":
                output.write_bytes(small_png(figure, dots, is_lines, options))
            else:
                metadata = {"CreationDate": None} if output.suffix.lower() == ".pdf" else {"Date": None}
                figure.savefig(output, metadata=metadata, **options)
        except OSError as error:
            raise PlotError(f"'{output}' cannot be written: {error.strerror}.") from error
    pyplot.close(figure)


def small_png(figure, dots, is_lines, options):
    for share in (1.0, 0.8, 0.64, 0.5, 0.4, 0.3):
        whole = io.BytesIO()
        figure.savefig(whole, dpi=share * dots, format="png", **options)
        if not is_lines and len(whole.getvalue()) <= LARGEST_PNG:
            break
        # A palette takes a third of the space; that of an octree keeps the colours of thin lines, a median cut does not.
        small = Image.open(whole).convert("RGB").quantize(255, method=Image.Quantize.FASTOCTREE)
        palette, corner = small.getpalette(), 3 * small.getpixel((0, 0))
        palette[corner:corner + 3] = [255, 255, 255]  # it makes 254 of white
        small.putpalette(palette)
        whole = io.BytesIO()
        small.save(whole, "png", optimize=True)
        if len(whole.getvalue()) <= LARGEST_PNG:
            break
    return whole.getvalue()
