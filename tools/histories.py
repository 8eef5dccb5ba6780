"""The tables of two runs of one scene, compared number by number: how, says RULE."""
import csv
import functools
import json
import math
import pathlib
import re
import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass

RULE = """Every number of `history.csv`, `bodies.csv`, `joints.csv` and the observers' tables counts but those of columns that tell how a step was computed: whose names end in `iterations`,
`residual`, `error`, `incompatibility`, `divergence` or `seconds`. A difference is over the scale of its number: the greatest value of its vector (columns that differ by x, y, z) in the run, of this solid
or joint, and at least a tenth of the greatest of the same unit in the table and of what the scene has of that unit, made of its greatest momentum or impulse, its longest step and the smallest length that its
grid resolves (1 of what has no unit and of angles). So what is zero by symmetry is measured against what could be there. A number in one run alone (a row, a column, one of them nan) counts as infinite. Columns of whole
numbers without a unit, those of contacts say, are counts: they are the same or not."""
OF_CONTACT = "Contact/Tolerance=1e-12"
OF_THE_SOLVING = re.compile(r"(iterations|solves|residual|error|incompatibility|divergence|seconds)$")
KEYS = ("step", "name")
FORMER = re.compile(r'\{"history.csv", "(\w+)",\s*"is called \\"(\w+)\\" now"\}')
PART = 0.1


@dataclass
class Table:
    units: dict  # column -> "m/s"
    rows: dict  # (step, name of the solid or joint) -> column -> text


@dataclass
class Difference:
    """The greatest one of a column, and the first step in which one is above the limit (None: in none)."""
    column: str  # "bodies vx"
    size: float = 0.
    step: int = 0
    name: str = ""
    first: int = None
    first_size: float = 0.

    def take(self, size, key, limit):
        if size > limit and self.first in (None, key[0]):
            self.first, self.first_size = key[0], max(size, self.first_size)
        if size > self.size:
            self.size, (self.step, self.name) = size, key

    def __str__(self):
        return f"{self.column}{f' of {self.name}' if self.name else ''}, step {self.step}"


@dataclass
class Comparison:
    differences: list
    counts: dict  # column -> the first step in which it is not the same
    n_numbers: int

    def greatest(self):
        return max(self.differences, key=lambda found: found.size)

    def first(self):
        """The difference that is above the limit first, of several the greatest; None if there is none."""
        above = [found for found in self.differences if found.first is not None]
        return min(above, key=lambda found: (found.first, -found.first_size), default=None)


@functools.lru_cache
def former_columns():
    """Former name of a column -> its name."""
    return dict(FORMER.findall((pathlib.Path(__file__).parents[1] / "src/parameters/former_names.cpp").read_text()))


def with_present_names(by_column):
    """Tables of an older program are compared with those of a newer one."""
    return {former_columns().get(column, column): value for column, value in by_column.items()}


def read_table(path):
    lines = path.read_text().splitlines()
    units = dict(re.match(r"# (.+?) \[([^]]*)\]", line).groups() for line in lines if line.startswith("#"))
    rows = csv.DictReader(line for line in lines if not line.startswith("#"))
    return Table(with_present_names(units), {(int(row["step"]), row.get("name", "")): with_present_names(row) for row in rows})


def read_tables(folder):
    """All tables of a run, by name."""
    return {path.stem: read_table(path) for path in sorted(pathlib.Path(folder).glob("*.csv"))}


def value(text):
    return None if text is None else float(text)


def vector_of(column):
    return re.sub("_?[xyz]$", "", column)


def sizes(tables, table, column):
    """Key -> greatest finite value there, of both runs."""
    found = {}
    for one in tables:
        for key, row in one[table].rows.items() if table in one else ():
            size = abs(value(row.get(column)) or 0.)
            found[key] = max(found.get(key, 0.), size if math.isfinite(size) else 0.)
    return found


def scales_of_scene(tables, length):
    """Unit -> size of what a scene has of it."""
    momentum = step = 0.
    for column, unit in tables[0]["history"].units.items():
        if unit == "kg m/s":
            momentum = max([momentum, *sizes(tables, "history", column).values()])
        elif column == "dt":
            step = max([step, *sizes(tables, "history", column).values()])
    if step == 0:
        return {}
    force, speed = momentum / step, length / step
    return {"1": 1., "rad": 1., "s": step, "m": length, "m^2": length**2, "m^3": length**3, "m/s": speed, "rad/s": 1 / step, "kg m/s": momentum,
            "kg m^2/s": momentum * length, "N": force, "N m": force * length, "J": force * length, "W": force * speed,
            "rad, m": length, "m, rad": length, "rad/s, m/s": speed, "N m, N": force * length}


def scales(tables, table, units, of_scene):
    """(vector, unit, name) -> what a difference there is measured against."""
    of_vectors, of_units = {}, {}
    for column, unit in units.items():
        for (_, name), size in sizes(tables, table, column).items():
            vector = vector_of(column), unit, name
            of_vectors[vector] = max(of_vectors.get(vector, 0.), size)
            if unit != "1":
                of_units[unit] = max(of_units.get(unit, 0.), size)
    return {(vector, unit, name): max(size, PART * of_units.get(unit, 0.), PART * of_scene.get(unit, 0.))
            for (vector, unit, name), size in of_vectors.items()}


def is_count(pair, column):
    """True if all values in a column without unit are whole numbers."""
    return all(float(row[column]).is_integer() for one in pair for row in one.rows.values() if column in row)


def difference(a, b, scale):
    if a is None or b is None:
        return math.inf
    if a == b or (math.isnan(a) and math.isnan(b)):
        return 0.
    return abs(a - b) / scale if math.isfinite(a - b) else math.inf


def compare(tables, length, limit):
    """`tables`: those of two runs; `length`: the smallest that the grid resolves [m]."""
    of_scene = scales_of_scene(tables, length)
    found = Comparison([], {}, 0)
    for table in sorted(tables[0].keys() | tables[1].keys()):
        if not all(table in one for one in tables):
            found.differences.append(Difference(f"{table}.csv in one run alone", math.inf, first=0))
            continue
        pair = [one[table] for one in tables]
        units = {column: unit for column, unit in {**pair[1].units, **pair[0].units}.items()
                 if column not in KEYS and not OF_THE_SOLVING.search(column)}
        keys = sorted(pair[0].rows.keys() | pair[1].rows.keys())
        known = scales(tables, table, units, of_scene)
        for column, unit in units.items():
            counts = unit == "1" and is_count(pair, column)
            one = Difference(f"{table} {column}")
            for key in keys:
                a, b = (value(table.rows.get(key, {}).get(column)) for table in pair)
                found.n_numbers += 1
                if counts and a is not None and b is not None:
                    if a != b:
                        found.counts.setdefault(one.column, key[0])
                else:
                    one.take(difference(a, b, known[vector_of(column), unit, key[1]]), key, limit)
            found.differences.append(one)
    return found


def has_contact(scene):
    """True if a scene file leaves contact on, whose iteration then wants a tolerance as tight as the solves have."""
    contact = ElementTree.parse(scene).getroot().find("ParameterList[@name='Contact']/Parameter[@name='Type']")
    return contact is None or contact.get("value") != "none"


def compare_runs(folders, limit):
    summary = json.loads((pathlib.Path(folders[0]) / "summary.json").read_text())
    return compare([read_tables(folder) for folder in folders], summary["smallest_length"], limit)
