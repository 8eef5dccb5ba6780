"""Reads the series of frames_test.cpp with h5py and an XML parser, as a user's script would.

Every array that frames.xmf mentions must exist with the extents and the precision it claims.
"""
import os
import sys
import xml.etree.ElementTree as ElementTree

import h5py
import numpy


def read_item(folder, item):
    file, path = item.text.strip().split(":")
    with h5py.File(os.path.join(folder, file), "r") as frame:
        values = frame[path][...]
    extents = tuple(int(n) for n in item.get("Dimensions").split())
    assert values.shape == extents, (path, values.shape, extents)
    assert values.dtype.itemsize == int(item.get("Precision")), path
    assert (values.dtype.kind == "f") == (item.get("NumberType") == "Float"), path
    return values


def read_grid(folder, grid):
    arrays = {a.get("Name"): read_item(folder, a.find("DataItem")) for a in grid.iter("Attribute")}
    arrays["units"] = {a.get("Name"): a.find("Information").get("Value")
                       for a in grid.iter("Attribute")}
    arrays["topology"] = grid.find("Topology").get("TopologyType")
    if arrays["topology"] == "3DCoRectMesh":
        arrays["nodes"] = [int(n) for n in grid.find("Topology").get("Dimensions").split()]
        arrays["corner"], arrays["spacing"] = (
            [float(x) for x in item.text.split()] for item in grid.find("Geometry"))
    else:
        arrays["simplices"] = read_item(folder, grid.find("Topology/DataItem"))
        arrays["vertices"] = read_item(folder, grid.find("Geometry/DataItem"))
    return arrays


def read_series(folder):
    root = ElementTree.parse(os.path.join(folder, "frames.xmf")).getroot()
    assert root.get("Version") == "3.0"
    series = root.find("Domain/Grid")
    assert series.get("CollectionType") == "Temporal"
    return [(float(frame.find("Time").get("Value")),
             {grid.get("Name"): read_grid(folder, grid) for grid in frame.findall("Grid")})
            for frame in series.findall("Grid")]


def check_fluid(fluid, number, depth):
    k, j, i = numpy.mgrid[0:depth, 0:4, 0:4]
    there = ~((i >= 2) & (j >= 2))
    expected = numpy.where(there, 1000.0 * number + i + 10 * j + 100 * k, 0.0)
    numpy.testing.assert_array_equal(fluid["pressure"], expected)
    expected = numpy.stack([i, j, k], axis=-1) * there[..., None]
    numpy.testing.assert_array_equal(fluid["velocity"], expected)
    assert fluid["units"] == {"pressure": "Pa", "velocity": "m/s"}
    assert fluid["nodes"] == [depth + 1, 5, 5]


def check_origin(attributes, parameters):
    assert attributes["commit"] == ("0123abc" if parameters else ""), attributes["commit"]
    assert attributes["scene"] == ("sc\u00e8ne.xml" if parameters else ""), attributes["scene"]
    assert attributes["parameters"] == parameters


def check_3d(folder):
    series = read_series(folder)
    assert [time for time, _ in series] == [0.0, 0.1]
    for number, (_, grids) in enumerate(series):
        check_fluid(grids["fluid"], number, 2)
        assert grids["fluid"]["corner"] == [-3, -2, -1]
        assert grids["fluid"]["spacing"] == [0.125, 0.25, 0.5]
        assert grids["fluid"]["pressure"].dtype == numpy.float32
        ball = grids["ball & chain"]
        height = [0.25, 0.5][number]
        assert ball["topology"] == "Triangle"
        assert ball["simplices"].tolist() == [[0, 1, 2]]
        assert ball["vertices"].tolist() == [[0, 0, height], [1, 0, height], [0, 1, height]]
        assert ball["speed"].tolist() == [1.5, 2.5, height]
        assert ball["normal"].tolist() == [[0, 0, 1]]
    with h5py.File(os.path.join(folder, "frames.h5"), "r") as master:
        assert master["times"][...].tolist() == [0.0, 0.1]
        assert master["steps"][...].tolist() == [0, 10]
        assert master["frame-000001"].attrs["time"] == 0.1
        for holder in (master, master["frame-000000"], master["frame-000001"]):
            check_origin(holder.attrs, 100000 * "p")
        assert master["frame-000001/fluid/pressure"][1, 0, 3] == 1103
        assert master["frame-000001/fluid/pressure"].attrs["unit"] == b"Pa"


def check_2d(folder):
    with h5py.File(os.path.join(folder, "frames.h5"), "r") as master:
        check_origin(master["frame-000000"].attrs, "")
    (time, grids), = read_series(folder)
    assert time == 0.0
    check_fluid(grids["fluid"], 0, 1)
    assert grids["fluid"]["corner"] == [-0.5, -2, -1]
    assert grids["fluid"]["spacing"] == [0.5, 0.25, 0.5]
    assert grids["fluid"]["pressure"].dtype == numpy.float64
    disc = grids["disc"]
    assert disc["topology"] == "Polyline"
    assert disc["simplices"].tolist() == [[0, 1], [1, 2]]
    assert disc["vertices"].tolist() == [[0, 0, 0], [1, 0, 0], [1, 1, 0]]
    assert disc["velocity"].tolist() == [[1, 2, 0], [3, 4, 0], [5, 6, 0]]


check_3d(os.path.join(sys.argv[1], "3d"))
check_2d(os.path.join(sys.argv[1], "2d"))
print("frames.h5 and frames.xmf agree with what was written")
