"""Fields as OpenVDB files, read back: values, places, names. Usage: test_volumes.py SIMULATE"""
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy
import pyopenvdb as openvdb

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tools"), str(ROOT / "tests" / "support")]
from lockstep_frames import read_frames  # noqa: E402
from scene_xml import xml  # noqa: E402

LEVEL = .53


def scene(dimension, fluid):
    return xml("Scene", {
        "Dimension": dimension,
        "Domain": {"Lower": (-1., 0., 2.)[:dimension], "Upper": (.5, 1., 2.5)[:dimension], "Cells": (24, 16, 8)[:dimension]},
        "Fluid": {"Density": 1000., "Gravity": (0., -9.8, 0.)[:dimension], **fluid},
        "Time": {"End": .02, "Fixed Step": .01}})


class Volumes(unittest.TestCase):
    def export(self, dimension, fluid, *options):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        root = Path(folder.name)
        (root / "scene.xml").write_text(scene(dimension, fluid))
        subprocess.run([sys.argv[1], root / "scene.xml", "--output", root / "run", "--quiet"], check=True)
        self.result = subprocess.run([ROOT / "tools/export-volumes", root / "run", *options], capture_output=True, text=True)
        self.frames = read_frames(root / "run")
        return sorted((root / "run" / "volumes").glob("*.vdb")) if self.result.returncode == 0 else []

    def test_smoke_and_velocity(self):
        source = {"Shape": "ball", "Center": (-.4, .4, 2.2), "Radius": .2, "Smoke": .75}
        for dimension in (2, 3):
            fluid = {"Smoke": {"Ambient": 0.}, "Sources": {"s": {**source, "Center": source["Center"][:dimension]}}}
            files = self.export(dimension, fluid)
            self.assertEqual(len(files), len(self.frames))
            density = openvdb.read(str(files[-1]), "density")
            expected = self.frames[-1]["fluid"].values("smoke").reshape(-1, 16, 24).swapaxes(0, 2)
            found = numpy.zeros(expected.shape, dtype="f4")
            density.copyToArray(found)
            numpy.testing.assert_array_equal(found, expected.astype("f4"))
            self.assertGreater(found.max(), .5)
            # Cells without smoke take no room; the centre of the first cell is where it is.
            self.assertEqual(density.activeVoxelCount(), numpy.count_nonzero(found))
            centre = (-1 + 1 / 32, 1 / 32, 2 + 1 / 32 if dimension == 3 else 0)
            numpy.testing.assert_allclose(density.transform.indexToWorld((0, 0, 0)), centre, atol=1e-12)
            self.assertEqual(openvdb.read(str(files[-1]), "velocity").valueTypeName, "vec3s")
            self.assertEqual(openvdb.readMetadata(str(files[-1]))["time"], self.frames[-1].time)

    def test_the_surface_is_a_level_set(self):
        files = self.export(3, {"Free Surface": {"Liquid": {"Pool": {"Type": "level", "Height": LEVEL}}}}, "--frame", "0")
        self.assertEqual(len(files), 1)
        surface = openvdb.read(str(files[0]), "surface")
        self.assertEqual(surface.gridClass, openvdb.GridClass.LEVEL_SET)
        for index in ((3, 8, 2), (20, 9, 5)):
            height = surface.transform.indexToWorld(index)[1]
            self.assertAlmostEqual(surface.getConstAccessor().getValue(index), height - LEVEL, delta=1e-6)
        self.assertAlmostEqual(surface.getConstAccessor().getValue((5, 1, 5)), -3 / 16, delta=1e-6)

    def test_unknown_fields_are_named(self):
        self.export(2, {}, "--fields", "smok")
        self.assertEqual(self.result.returncode, 2)
        self.assertIn("no field 'smok'", self.result.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
