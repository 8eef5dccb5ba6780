"""What each of the paper's figures shows happens, in the shipped scenes on coarse grids."""
import math
import sys
import tempfile
import unittest
from pathlib import Path

import numpy

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/support"))
from simulation import column, simulate, table  # noqa: E402
sys.path.insert(0, str(ROOT / "tools"))
from lockstep_frames import read_frames  # noqa: E402


class Run:
    """A shipped scene with `settings`; what `history.csv` and `bodies.csv` say, and, of `frames`, what read makes of them."""

    def __init__(self, scene, cells, *settings, end=None, frames=None, seconds=600):
        options = [f"Domain/Cells={{{', '.join(map(str, cells))}}}", f"Output/Frames={'true' if frames else 'false'}", *settings]
        options = [word for setting in options for word in ("--set", setting)]
        with tempfile.TemporaryDirectory() as folder:
            simulate(ROOT / f"xml-params/scenes/{scene}.xml", folder, *options, *(("--end-time", end) if end else ()), seconds=seconds)
            self.history = table(Path(folder) / "history.csv")
            self.bodies = table(Path(folder) / "bodies.csv")
            self.frames = [frames(frame) for frame in read_frames(folder)] if frames else []
        self.times = column(self.history, "time")

    def of(self, name, what):
        """A column of bodies.csv, a value a step."""
        return column([row for row in self.bodies if row["name"] == name], what)

    def between(self, values, begin, end):
        """Those of the steps that end in that time [s]."""
        return [value for time, value in zip(self.times, values) if begin < time <= end]

    def mean(self, values, begin, end=math.inf):
        return float(numpy.mean(self.between(values, begin, end)))
