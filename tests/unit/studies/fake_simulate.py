#!/usr/bin/python3
"""Stands in for simulate: a 'scene' whose error is h^2 + offset, in the files a run leaves behind. Its frames hold
a unit square, "Ball 1", that breathes by a tenth with a period of 0.4 s, and a velocity (0, -x (1 - (y - 0.4)^2)).

Understands --output and the settings Domain/Cells, Solids/Ball/Position, Fake/Fail (an exit code) and Fake/Seconds.
"""
import json
import math
import os
import sys
import time
from pathlib import Path

import h5py

arguments = sys.argv[2:]
folder, settings = None, {}
for flag, value in zip(arguments[::2], arguments[1::2]):
    if flag == "--output":
        folder = Path(value)
    elif flag == "--set":
        name, text = value.split("=", 1)
        settings[name] = text
    else:
        sys.exit(2)
if settings.get("Fake/Fail", "0") != "0":
    print("S2 did not converge: residual 1.", file=sys.stderr)
    sys.exit(int(settings["Fake/Fail"]))
time.sleep(float(settings.get("Fake/Seconds", "0")))
rank = int(os.environ.get("OMPI_COMM_WORLD_RANK", "0"))
ranks = int(os.environ.get("OMPI_COMM_WORLD_SIZE", "1"))
if rank != 0:
    sys.exit(0)
cells = [int(n) for n in settings["Domain/Cells"].strip("{}").split(",")]
offset = float(settings.get("Solids/Ball/Position", "{0,0}").strip("{}").split(",")[0])
h = 1 / cells[0]
(folder / "history.csv").write_text(
    "# a comment\nstep,time,dt\n1,0.1,0.1\n2,0.2,0.1\n3,0.4,0.2\n")
(folder / "bodies.csv").write_text(
    "step,time,name,vx\n" + "".join(f"{k},0,Ball 1,{k * (2 + h * h + offset)}\n" for k in (1, 2, 3)))
(folder / "Wire 1.csv").write_text("step,time,height\n0,0,5\n2,0.2,7\n")
(folder / "Probes.csv").write_text("step,time,point,p\n" + "".join(f"{k},0,{i},{10 * k + i}\n" for k in range(4) for i in (1, 2)))
(folder / "summary.json").write_text(json.dumps({
    "cells": cells[0] * cells[1], "smallest_length": h, "wall_seconds": 2.0, "cpu_seconds": 1.5 * ranks, "ranks": ranks, "peak_memory_mb": 10 * ranks,
    "iterations": {"s1": {"median": 4, "max": 9}, "s2": {"median": 6, "max": 7}}}))
(folder / "used-parameters.xml").write_text(f"""<ParameterList name="Scene">
  <ParameterList name="Domain">
    <Parameter name="Lower" type="Array(double)" value="{{0, 0}}"/>
    <Parameter name="Upper" type="Array(double)" value="{{1, 1}}"/>
    <Parameter name="Cells" type="Array(int)" value="{{{cells[0]}, {cells[1]}}}"/>
  </ParameterList>
  <ParameterList name="Observers"> <ParameterList name="Wire 1"/> <ParameterList name="Probes"/> </ParameterList>
</ParameterList>
""")
(folder / "frames").mkdir()
(folder / "frames.xmf").write_text("".join(f"<DataItem>frames/frame-{k:06}.h5:/a</DataItem>" * 2 for k in range(25)))
for k in range(25):
    size = 1 + 0.1 * math.cos(2 * math.pi * k / 8)
    with h5py.File(folder / f"frames/frame-{k:06}.h5", "w") as file:
        file.attrs["time"] = 0.05 * k
        file["solids/Ball_1/vertices"] = [[0.0, 0, 0], [size, 0, 0], [size, size, 0], [0, size, 0]]
        file["solids/Ball_1/simplices"] = [[0, 1], [1, 2], [2, 3], [3, 0]]
        fluid = file.create_group("fluid")
        for axis, spacing in zip("xyz", (h, h, 1.0)):
            fluid.attrs[f"origin_{axis}"] = 0.0
            fluid.attrs[f"spacing_{axis}"] = spacing
        centers = [(i + 0.5) * h for i in range(cells[0])]
        fluid["velocity"] = [[[[0.0, -x * (1 - (y - 0.4) ** 2), 0.0] for x in centers] for y in centers]]
