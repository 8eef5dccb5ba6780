"""Runs a few steps of a scene on a coarse grid and looks at what it wrote.

Usage: run_scene.py SIMULATE SCENE.xml RANKS MPIEXEC
"""
import csv
import math
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
    cells = [int(n) for n in given.get("value").strip("{} ").split(",")] if given is not None else [32] * dimension
    ratio = math.gcd(*cells)
    smallest = [n // ratio for n in cells]
    factor = min(ratio, max(1, int((MOST_CELLS[dimension] / math.prod(smallest)) ** (1 / dimension))))
    return [n * factor for n in smallest]


def read_table(path):
    lines = [line for line in path.read_text().splitlines() if not line.startswith("#")]
    return list(csv.DictReader(lines))


def checked_errors(scene):
    """Nodes of soft bodies are pulled where the surface is, not at the faces' centres: angular momentum is
    then exact only in the limit of a fine grid."""
    types = {p.get("value") for p in xml.etree.ElementTree.parse(scene).getroot().findall(
        "ParameterList[@name='Solids']/ParameterList/Parameter[@name='Type']")}
    soft = types & {"deformable body", "cloth"}
    return ("momentum_error",) if soft else ("momentum_error", "angular_momentum_error")


def check_history(folder, errors):
    rows = read_table(folder / "history.csv")
    assert [int(row["step"]) for row in rows] == list(range(1, N_STEPS + 1)), f"steps {rows}"
    for row in rows:
        for column in errors:
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
        check_history(Path(folder), checked_errors(scene))
        check_frames(Path(folder), n_cells)


if __name__ == "__main__":
    main()
