"""Runs a few steps of a scene on a coarse grid and looks at what it wrote.

Usage: run_scene.py SIMULATE SCENE.xml RANKS MPIEXEC
"""
import csv
import json
import math
import re
import subprocess
import sys
import tempfile
import xml.etree.ElementTree
from pathlib import Path

import h5py
import numpy

N_STEPS = 3
MOST_CELLS = {2: 32**2, 3: 16**3}
LARGEST_MOMENTUM_ERROR = 1e-10


def coarse_cells(scene):
    """The domain's cells divided by one number, so that they stay squares or cubes."""
    root = xml.etree.ElementTree.parse(scene).getroot()
    dimension = int(root.find("Parameter[@name='Dimension']").get("value"))
    given = root.find("ParameterList[@name='Domain']/Parameter[@name='Cells']")
    as_shipped = re.sub(r"\[PaperSize \? \d+ : (\d+)\]", r"\1", given.get("value")) if given is not None else ""
    cells = [int(n) for n in as_shipped.strip("{} ").split(",")] if as_shipped else [32] * dimension
    ratio = math.gcd(*cells)
    smallest = [n // ratio for n in cells]
    factor = min(ratio, max(1, int((MOST_CELLS[dimension] / math.prod(smallest)) ** (1 / dimension))))
    return [n * factor for n in smallest]


def read_table(path):
    lines = [line for line in path.read_text().splitlines() if not line.startswith("#")]
    return list(csv.DictReader(lines))


def check_history(folder):
    rows = read_table(folder / "history.csv")
    assert [int(row["step"]) for row in rows] == list(range(1, N_STEPS + 1)), f"steps {rows}"
    for row in rows:
        for column in ("momentum_error", "angular_momentum_error"):
            value = float(row[column])
            assert value < LARGEST_MOMENTUM_ERROR, f"{column} is {value} in step {row['step']}"


def check_frames(folder, n_cells):
    with h5py.File(folder / "frames.h5") as file:
        frames = sorted(name for name in file if name.startswith("frame-"))
        assert frames, "no frames"
        assert len(file["times"]) == len(frames), f"{len(file['times'])} times for {len(frames)} frames"
        last = file[frames[-1]]
        for name in ("velocity", "pressure"):
            values = last["fluid"][name][...]
            assert values.size >= math.prod(n_cells), f"{name} has shape {values.shape}"
            assert numpy.isfinite(values).all(), f"{name} is not finite"
        for name, solid in last["solids"].items() if "solids" in last else []:
            vertices = solid["vertices"][...]
            assert vertices.size and numpy.isfinite(vertices).all(), f"vertices of {name}"
    assert "Xdmf" in (folder / "frames.xmf").read_text(), "frames.xmf"


def check_summary(folder):
    summary = json.loads((folder / "summary.json").read_text())
    assert summary["steps"] == N_STEPS, summary
    assert summary["cpu_seconds"] > 0, summary


def volumes(scene):
    """Names of the deformable volumes, as frames have them."""
    bodies = xml.etree.ElementTree.parse(scene).getroot().findall("ParameterList[@name='Solids']/ParameterList")
    return [re.sub("[^A-Za-z0-9.-]", "_", body.get("name")) for body in bodies
            if body.find("Parameter[@name='Type']").get("value") == "deformable body"]


def check_elements(folder, names):
    with h5py.File(folder / "frames.h5") as file:
        last = file[sorted(name for name in file if name.startswith("frame-"))[-1]]
        for name in names:
            elements = last["solids"][f"{name}_elements"]
            n_elements = len(elements["simplices"])
            assert elements["simplices"][...].max() < len(elements["vertices"]), f"corners of {name}"
            for field, shape in (("stress", (n_elements, 6)), ("strain", (n_elements, 6)),
                                 ("von_Mises_stress", (n_elements,)), ("energy_density", (n_elements,))):
                values = elements[field][...]
                assert values.reshape(shape).size and numpy.isfinite(values).all(), f"{field} of {name}"


def main():
    simulate, scene, ranks, mpiexec = sys.argv[1:]
    n_cells = coarse_cells(scene)
    with tempfile.TemporaryDirectory() as folder:
        command = [simulate, scene, "--output", folder, "--steps", str(N_STEPS),
                   "--set", "Domain/Cells={" + ", ".join(map(str, n_cells)) + "}",
                   "--set", "Output/Frames=true", "--set", "Output/Frame Interval=0"]
        if ranks != "1":
            command = [mpiexec, "--oversubscribe", "-np", ranks, *command]
        result = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        print(" ".join(command), result.stdout, sep="\n")
        assert result.returncode == 0, f"exit code {result.returncode}"
        check_history(Path(folder))
        check_summary(Path(folder))
        check_frames(Path(folder), n_cells)
        check_elements(Path(folder), volumes(scene))


if __name__ == "__main__":
    main()
