"""Fills the balloon on a coarse grid, in small and large steps, and looks for smoke outside before its mouth is let go.

Usage: check_balloon.py SIMULATE SCENE.xml
"""
import subprocess
import sys
import tempfile
from pathlib import Path

import h5py
import numpy

CELLS = (16, 24, 16)
LOWER, UPPER = numpy.array([-0.5, 0, -0.5]), numpy.array([0.5, 1.5, 0.5])
RELEASE_TIME = 1.0
TIME_STEPS = 0.1, 0.02, 0.005


def inside(vertices, triangles):
    """[z][y][x]: cells whose centre is in the balloon, by counting what lies above: the mouth is on the floor."""
    spacing = (UPPER - LOWER) / CELLS
    x, y, z = (LOWER[a] + spacing[a] * (numpy.arange(CELLS[a]) + 0.5) for a in range(3))
    x = x + 1e-6 * spacing[0]                                 # never above an edge of the mesh
    z = z + 1.7e-6 * spacing[2]
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    px, pz = x[None, :, None], z[:, None, None]               # [z][x][triangle]

    def side(p, q):
        return (q[:, 0] - p[:, 0]) * (pz - p[:, 2]) - (q[:, 2] - p[:, 2]) * (px - p[:, 0])

    weights = [side(b, c), side(c, a), side(a, b)]
    area = sum(weights)
    hit = numpy.all([w * numpy.sign(area) > 0 for w in weights], axis=0)
    with numpy.errstate(divide="ignore", invalid="ignore"):
        height = sum(w * v[:, 1] for w, v in zip(weights, (a, b, c))) / area
    above = hit[:, None] & (height[:, None] > y[None, :, None, None])
    return above.sum(axis=-1) % 2 == 1


def smoke_of(frames):
    """Largest amount of smoke outside in any frame, and smoke inside in the last one [cells]."""
    most, filled = 0, 0
    for path in sorted(frames.glob("frame-*.h5")):
        with h5py.File(path) as frame:
            smoke = frame["fluid/smoke"][...]
            balloon = frame["solids/Balloon"]
            within = inside(balloon["vertices"][...], balloon["simplices"][...].astype(int))
        most = max(most, numpy.abs(smoke[~within]).sum())
        filled = smoke[within].sum()
    return most, filled


def main():
    simulate, scene = sys.argv[1:]
    for step in TIME_STEPS:
        with tempfile.TemporaryDirectory() as folder:
            command = [simulate, scene, "--output", folder, "--end-time", str(0.999 * RELEASE_TIME), "--quiet",
                       "--set", "Domain/Cells={%d, %d, %d}" % CELLS,
                       "--set", "Solids/Balloon/Geometry/Mesh Spacing=0.05", "--set", f"Time/Fixed Step={step}",
                       "--set", "Output/Frame Interval=0.1"]
            subprocess.run(command, check=True)
            most, filled = smoke_of(Path(folder) / "frames")
            print(f"step {step} s: smoke in cells: {filled:.4g} inside at the end, at most {most:.4g} outside")
            assert filled > 50, "the balloon was not filled"
            assert most == 0, "smoke leaks through the cloth"


if __name__ == "__main__":
    main()
