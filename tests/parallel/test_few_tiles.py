"""Ranks that own no tile of the grid, or no node of a soft solid, take part in every collective call: scenes of one
tile, and bodies of few nodes, end on any number of ranks, with the answer of one."""
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from scene_xml import xml  # noqa: E402
from simulation import STATE, column, simulate, table  # noqa: E402

N_STEPS = 3


def box(dimension, size, **more):
    return {"Type": "deformable body", "Geometry": {"Shape": "box", "Size": (size,) * dimension},
            "Material": {"Young's Modulus": 1e4}, "Density": 2000., "Position": (.5,) * dimension, **more}


def pinned(dimension, height):
    return {"Pinned": {"p": {"Lower": (-1.,) * dimension, "Upper": (1., height, 1.)[:dimension]}}}


def ball(dimension, **more):
    return {"Type": "rigid body", "Geometry": {"Shape": "ball", "Radius": .15}, "Density": 500.,
            "Position": (.5,) * dimension, **more}


def segment(y, integration):
    """A cloth of two nodes."""
    return {"Type": "cloth", "Geometry": {"Shape": "sheet", "Size": (.1, 0.), "Normal": "y", "Mesh Spacing": .2},
            "Young's Modulus": 1e3, "Thickness": .01, "Surface Density": 50., "Position": (.5, y),
            "Time Integration": integration}


def pool(interface):
    return {"Free Surface": {"Interface": {"Type": interface}, "Liquid": {"Pool": {"Type": "level", "Height": .55}},
                             "Watch": {"Tank": {"Point": (.2, .2)}}}}


def scene(dimension, solids, coupling, viscosity=0., surface={}):
    n_cells = {2: 16, 3: 8}[dimension]  # one tile
    return xml("Scene", {
        "Dimension": dimension, "Domain": {"Cells": (n_cells,) * dimension},
        "Fluid": {"Density": 1000., "Gravity": (0., -9.8, 0.)[:dimension], "Viscosity": viscosity, **surface},
        "Solids": solids, "Coupling": {"Type": coupling}, "Time": {"End": 1., "Fixed Step": .005}})


def run(text, ranks):
    """The last states of the bodies, or what went wrong."""
    with tempfile.TemporaryDirectory() as folder:
        file, output = Path(folder) / "scene.xml", Path(folder) / "output"
        file.write_text(text)
        simulate(file, output, "--steps", N_STEPS, ranks=ranks, seconds=120)
        return [row for row in table(output / "bodies.csv") if row["step"] == str(N_STEPS)]


SOFT_2D = box(2, .3, **{"Time Integration": "fully-implicit"}, **pinned(2, -.14))
CASES = [  # name, dimension, solids, ranks, more
    ("soft", 2, {"Soft": SOFT_2D}, (2, 3), {}),
    ("soft, 3D", 3, {"Soft": box(3, .4, **pinned(3, -.2))}, (2,), {}),
    ("rigid", 2, {"Ball": ball(2)}, (2, 3), {"viscosity": 1.}),
    ("rigid, 3D", 3, {"Ball": ball(3)}, (3,), {}),
    ("both", 2, {"Soft": SOFT_2D, "Ball": ball(2, Position=(.5, .8))}, (3,), {"viscosity": 1.}),
    ("two nodes, which ranks beyond own none of", 2, {"Cloth": segment(.5, "second-order")}, (3,), {}),
    ("watched water", 2, {"Ball": ball(2)}, (2,), {"surface": pool("particle level set")}),
    ("watched volumes of water", 2, {"Ball": ball(2)}, (3,), {"surface": pool("volume of fluid")}),
    ("several explicit bodies", 2, {"A": segment(.3, "explicit"), "B": segment(.6, "explicit")}, (5,), {}),
]


class FewTiles(unittest.TestCase):
    def test_ranks_without_tiles(self):
        for name, dimension, solids, ranks, more in CASES:
            for coupling in ("mixed face", "flux"):
                text = scene(dimension, solids, coupling, **more)
                expected = run(text, 1)
                for n in ranks:
                    with self.subTest(f"{name}, {coupling}, {n} ranks"):
                        self.compare(run(text, n), expected)

    def compare(self, found, expected):
        self.assertEqual(len(found), len(expected))
        for name in STATE:
            for one, other in zip(column(found, name), column(expected, name)):
                self.assertAlmostEqual(one, other, delta=1e-6, msg=name)


if __name__ == "__main__":
    unittest.main()
