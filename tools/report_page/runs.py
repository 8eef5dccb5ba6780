"""Contents of a run's folder besides its frames: facts, tables and parameters."""
import csv
import json
from pathlib import Path

import numpy

from lockstep_frames import FramesError
from run_parameters import FILE, numbers, read_parameters, view_of

from report_page.blobs import pack_numbers
from report_page.state import progress_of, state_of

MOST_ROWS = 20_000  # rows of a table; of longer ones every nth
HISTORY = "history.csv"


def pack_run(folder, blobs, frames):
    """All that the page shows of a run, as plain values; arrays go to the blobs."""
    folder = Path(folder)
    if not (folder / FILE).is_file():
        raise FramesError(f"{folder} is no output folder of a run: it holds no {FILE}.")
    parameters = read_parameters(folder)
    values = {name: value for name, value, _ in parameters}
    summary = read_summary(folder)
    tables = {path.name: read_table(path) for path in sorted(folder.glob("*.csv"))}
    packed_frames = frames.pack(folder)
    return {
        "folder": folder.resolve().name,
        "title": values.get("Title", "").strip(),
        "dimension": int(values.get("Dimension", 3)),
        "view": view_of(values),
        "domain": domain(values, packed_frames["frames"]),
        "facts": facts(summary, values, tables.get(HISTORY)),
        "stages": summary.get("stages", []),
        "parameters": [(name, value) for name, value, is_default in parameters if not is_default],
        "scene": "".join(path.read_text(errors="replace") for path in (folder / "input.xml", folder / "input.yaml") if path.is_file()),
        "tables": pack_tables(tables, blobs),
        **packed_frames,
    }


def domain(values, frames):
    """Its corners. A fluid of one's own may have another kind of domain: then those of what its frames show."""
    if "Domain/Lower" in values and "Domain/Upper" in values:
        return [numbers(values[f"Domain/{corner}"]) for corner in ("Lower", "Upper")]
    lower, upper = [], []
    for frame in frames:
        shown = [surface["points"] for surface in frame["surfaces"] if surface["points"]["n"]]
        lower += [points["low"] for points in shown]
        upper += [numpy.add(points["low"], points["size"]) for points in shown]
        if "box" in frame:
            box = {name: numpy.resize(values, 3) for name, values in frame["box"].items()}
            lower.append(box["origin"])
            upper.append(box["origin"] + box["spacing"] * box["cells"])
    if not lower:
        return [[0.] * 3, [1.] * 3]
    return [numpy.min(lower, axis=0).tolist(), numpy.max(upper, axis=0).tolist()]


def differing_parameters(folders):
    """(name, value in each run) of the parameters in which runs differ."""
    runs = [{name: value for name, value, _ in read_parameters(folder)}
            for folder in folders]
    names = list(dict.fromkeys(name for run in runs for name in run))
    rows = [(name, [run.get(name, "") for run in runs]) for name in names]
    return [(name, values) for name, values in rows if len(set(values)) > 1]


def read_summary(folder):
    try:
        return json.loads((folder / "summary.json").read_text())
    except OSError:
        return {}
    except ValueError as error:
        raise FramesError(f"{folder / 'summary.json'} is not proper JSON: {error}.") from error


def read_table(path):
    """A table of a run: columns with unit and meaning, and its rows as texts."""
    columns, lines = {}, []
    with open(path, newline="") as file:
        for line in file:
            if line.startswith("#"):
                name, _, meaning = line[1:].strip().partition(" [")
                unit, _, meaning = meaning.partition("]:")
                columns[name] = {"name": name, "unit": unit, "meaning": meaning.strip()}
            else:
                lines.append(line)
    rows = list(csv.reader(lines))
    names = rows[0] if rows else []
    # A row that is being written may lack its end.
    return {"columns": [columns.get(name, {"name": name, "unit": "", "meaning": ""}) for name in names],
            "rows": [row for row in rows[1:] if len(row) == len(names)]}


def pack_tables(tables, blobs):
    """Packs tables; one with several rows a time, told apart by a column `name`, as one table for each name under `named`."""
    packed = {}
    for file, table in tables.items():
        names = [column["name"] for column in table["columns"]]
        if "time" in names and "name" in names:
            packed[file] = {"named": pack_by_name(table, names.index("name"), blobs)}
        elif "time" in names:
            packed[file] = pack_rows(table["columns"], table["rows"], blobs)
    return packed


def pack_by_name(table, which, blobs):
    rows_of = {}
    for row in table["rows"]:
        rows_of.setdefault(row[which], []).append(row[:which] + row[which + 1:])
    columns = table["columns"][:which] + table["columns"][which + 1:]
    return {name: pack_rows(columns, rows, blobs) for name, rows in rows_of.items()}


def pack_rows(columns, rows, blobs):
    every = max(1, -(-len(rows) // MOST_ROWS))
    values = numpy.array([[number(word) for word in row] for row in rows[::every]], float)
    return {"columns": columns, "n": len(rows[::every]), "every": every,
            "blob": pack_numbers(blobs, values.reshape(-1, len(columns)).T)}


def number(word):
    try:
        return float(word)
    except ValueError:
        return numpy.nan


def facts(summary, values, history):
    """Facts of a run, as lines of a table."""
    versions = summary.get("versions", {})
    last = last_row(history)
    n_cells = [int(n) for n in numbers(values["Domain/Cells"])] if "Domain/Cells" in values else None
    found = [
        ("state", state_of(summary)),
        ("progress", progress_of(summary, values, history)),
        ("grid", " x ".join(map(str, n_cells)) + f" = {int(numpy.prod(n_cells)):,} cells" if n_cells else None),
        ("simulated time", f"{float(last['time']):.6g} s in {last['step']} steps" if last else "no step yet"),
        ("wall time", f"{summary['wall_seconds']:.4g} s" if "wall_seconds" in summary else None),
        ("ranks", summary.get("ranks")),
        ("machine", machine(summary.get("machine", {}))),
        ("memory", f"{summary['peak_memory_mb']:.4g} MB of all ranks" if "peak_memory_mb" in summary else None),
        ("unknowns", f"{summary['pressure_unknowns']:,} pressures, {summary['solid_unknowns']:,} of solids"
         if "pressure_unknowns" in summary else None),
        ("iterations", ", ".join(f"{name.upper()} {of['median']:g} (at most {of['max']})"
                                 for name, of in summary.get("iterations", {}).items()) or None),
        ("largest momentum error", f"{summary['largest_momentum_error']:.2g}"
         if summary.get("largest_momentum_error") is not None else None),
        ("worst residual", f"{summary['worst_residual']:.2g}" if "worst_residual" in summary else None),
        ("Lockstep", f"{versions['lockstep']} ({versions['git']}), {versions['build']}, {versions['compiler']}"
         if versions else None),
        ("libraries", f"Trilinos {versions['trilinos']}, {versions['mpi']}, HDF5 {versions['hdf5']}"
         if versions else None),
        ("command", summary.get("command")),
    ]
    return [(name, str(value)) for name, value in found if value is not None]


def last_row(table):
    return dict(zip([column["name"] for column in table["columns"]], table["rows"][-1])) if table and table["rows"] else {}


def machine(of):
    parts = [of.get("processor"), f"{of['cores']} cores" if "cores" in of else None, of.get("system")]
    return ", ".join(part for part in parts if part) or None
