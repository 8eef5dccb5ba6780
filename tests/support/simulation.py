"""Runs scenes with `simulate` and reads the tables that it writes."""
import csv
import math
import os
import pathlib
import subprocess
import tempfile

SIMULATE = os.environ.get("LOCKSTEP_SIMULATE", "build/release/drivers/simulate")
AUDITED = os.environ.get("LOCKSTEP_SIMULATE_AUDITED", "build/release/tests/leaks/simulate_audited")
MPIEXEC = os.environ.get("LOCKSTEP_MPIEXEC", "mpirun")
STATE = ("x", "y", "vx", "vy")
FLUID = ("liquid_volume", "fluid_momentum_y", "fluid_kinetic_energy")


def attempt(file, output, *options, ranks=1, seconds=300, audited=False):
    """However it ends; a run of these tests usually takes a few seconds. `audited`: it ends where liquid goes through a solid."""
    command = [] if ranks == 1 else [MPIEXEC, "--oversubscribe", "-np", str(ranks)]
    command += [AUDITED if audited else SIMULATE, str(file), "--output", str(output), "--quiet", *map(str, options)]
    return subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=seconds)


def simulate(file, output, *options, **more):
    """Fails with what the program said unless it ends well; `more`: of `attempt`."""
    result = attempt(file, output, *options, **more)
    assert result.returncode == 0, result.stdout[-4000:]


def histories(text, *options, **more):
    """Rows of history.csv and of bodies.csv (none without bodies) of a scene, as text; `more`: of `attempt`."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "scene.xml").write_text(text)
        simulate(folder / "scene.xml", folder / "output", *options, **more)
        bodies = folder / "output/bodies.csv"
        return table(folder / "output/history.csv"), table(bodies) if bodies.exists() else []


def table(path):
    """Rows by name of column, as text."""
    lines = path.read_text().splitlines()
    return list(csv.DictReader(line for line in lines if not line.startswith("#")))


def column(rows, name):
    """Its numbers; all of them must be some, because neither `max` nor `>` would find one that is none."""
    values = [float(row[name]) for row in rows]
    assert all(map(math.isfinite, values)), f"{name}: not finite in row {[*map(math.isfinite, values)].index(False) + 1}"
    return values


def without_times(rows):
    """The rows without what a clock wrote."""
    return [{name: value for name, value in row.items() if name != "wall_seconds"} for row in rows]


def assert_close(one, other, names, tolerance):
    """Columns of as many rows are apart by no more than a part of their largest entry."""
    assert len(one) == len(other), f"{len(one)} rows and {len(other)}"
    for name in names:
        largest = max(map(abs, column(one, name)))
        apart = max(abs(a - b) for a, b in zip(column(one, name), column(other, name)))
        assert apart <= tolerance * largest, f"{name}: {apart:.3g} apart, of {largest:.3g} at most {tolerance:g}"
