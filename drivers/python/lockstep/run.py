"""A run of a scene, to be stepped."""
import math
import os
from collections.abc import Mapping
from dataclasses import dataclass
from types import TracebackType
from typing import Any, Callable, Dict, List, Optional, Sequence, Tuple, Type, Union

import numpy as np

from . import _core
from .names import Named, NearNames
from .scene_text import json_of, settings_of

Path = Union[str, bytes, "os.PathLike[str]"]
Scene = Union[Path, "Mapping[str, Any]"]
Numbers = Union[float, Sequence[float], np.ndarray]


@dataclass(frozen=True)
class Grid(NearNames):
    """The box of cells of a fluid."""

    cells: Tuple[int, ...]
    """Number of cells along x, y(, z)."""
    spacing: np.ndarray
    """Size of a cell along each axis [m]."""
    origin: np.ndarray
    """Lower corner of the box [m]."""

    @property
    def shape(self) -> Tuple[int, ...]:
        """Shape of the arrays of `Run.fields`: the cells along (z,) y, x; a vector field has its components behind it."""
        return self.cells[::-1]

    def centers(self) -> Tuple[np.ndarray, ...]:
        """Coordinates of the cells' centres [m], one array along each of x, y(, z)."""
        return tuple(low + h * (np.arange(n) + .5) for n, h, low in zip(self.cells, self.spacing, self.origin))


def numbers(given: Numbers) -> List[float]:
    """One number or several, of Python's kinds or of numpy's."""
    try:
        if isinstance(given, (str, bytes)):
            raise TypeError
        array = np.asarray(given, dtype=float)
    except (TypeError, ValueError):
        raise _core.InputError(f"{given} is neither a number nor a list of numbers.") from None
    if array.ndim > 1:
        raise _core.InputError(f"{given} is neither a number nor a list of numbers.")
    return [float(value) for value in np.atleast_1d(array)]


def request_of(scene: Scene) -> _core.OpenRequest:
    """A request for a scene that is a path, a text of XML or a dictionary."""
    request = _core.OpenRequest()
    if isinstance(scene, Mapping):
        request.scene, request.text, request.from_dictionary = "the dictionary of the scene", json_of(scene), True
    elif isinstance(scene, str) and scene.lstrip().startswith("<"):
        request.scene, request.text = "the text of the scene", scene
    else:
        request.scene = os.fsdecode(scene)
    return request


class Run(NearNames):
    """A run of a scene, to be stepped.

    All members are collective on several ranks: every rank calls them with the same arguments. What is wrong with a scene or an
    argument raises InputError, a ValueError; a solve that does not converge SolveError, an ArithmeticError; a full disk OutputError,
    an OSError. Their sentences are those of the programs.
    """

    def __init__(self, scene: Scene, output: Path = "output", settings: "Optional[Mapping[str, Any]]" = None, restart: Path = "",
                 quiet: bool = True, plug_ins: Sequence[Path] = ()) -> None:
        """Opens a scene and writes its start.

        scene: the path of a file; or its text, which begins with "<"; or a dictionary, {"Dimension": 2, "Fluid": {"Density": 1000}},
        in which dictionaries are lists, tuples arrays, and a text in brackets is a formula. Files that a text or a dictionary name
        are relative to the folder that the script runs in. output: the folder for frames, tables and checkpoints. settings: what
        `simulate --set` takes, {"Time/End": 2.0, "Domain/Cells": (64, 64)} or nested; "[2*R]" is a formula of the scene's constants.
        restart: a checkpoint to go on from; forces and targets set from here are not in it. quiet: no line a step. plug_ins:
        libraries of plug-ins to load, beside those that the scene names.
        """
        request = request_of(scene)
        request.output, request.restart, request.quiet = os.fsdecode(output), os.fsdecode(restart), bool(quiet)
        request.settings = settings_of(settings or {})
        request.plug_ins = [os.fsdecode(library) for library in plug_ins]
        self._callbacks: List[Callable[["Run"], Any]] = []
        self._observers: Dict[str, Tuple[Callable[["Run"], Numbers], List[Tuple[str, str]]]] = {}
        self._core = _core.Run(request)

    def step(self) -> bool:
        """Takes one step. False, and no step, at the end of the scene. Observers look and callbacks are called after it."""
        if not self._core.step():
            return False
        for name in self._observers:
            self._core.append_row(name, self._row(name))
        for callback in self._callbacks:
            callback(self)
        return True

    def reset(self) -> None:
        """Back to where the run was opened: the start of the scene, or its checkpoint.

        The scene is not read again, but built again; the folder is that of the new run. What set_force and set_target have set is
        gone; observers begin their tables anew and callbacks stay. A run that has failed may be reset, one that is closed not.
        """
        self._core.reset()
        for name in self._observers:
            self._begin(name)

    def close(self) -> None:
        """Writes the last checkpoint and summary.json.

        `with Run(...) as run:` does so by itself; after an exception it does so on one rank, and on several writes summary.json alone.
        """
        self._forget()
        self._core.close()

    def __enter__(self) -> "Run":
        return self

    def __exit__(self, kind: Optional[Type[BaseException]], error: Optional[BaseException],
                 traceback: Optional[TracebackType]) -> None:
        if kind is None:
            return self.close()
        self._forget()
        self._core.stop(f"{kind.__name__}: {error}")

    def on_step(self, callback: Callable[["Run"], Any]) -> Callable[["Run"], Any]:
        """Calls callback(run) after each step, behind the observers, in the order in which they came. Returns it, to be a decorator."""
        self._callbacks.append(callback)
        return callback

    def observe(self, name: str, function: Callable[["Run"], Numbers], columns: Sequence[Union[str, Tuple[str, str]]]) -> None:
        """Writes OUTPUT/NAME.csv beside the tables of the run: a row now and after each step.

        function(run) returns the row, a number or several; the columns `step` and `time` stand before them. columns: their names, or
        pairs of name and unit, ("draft", "m"). A run that goes on from a checkpoint goes on with the table. A number that is not
        finite raises OutputError.
        """
        pairs = [(column, "1") if isinstance(column, str) else (str(column[0]), str(column[1])) for column in columns]
        names = ["step", "time", *(column for column, _ in pairs)]
        if isinstance(columns, str) or len(set(names)) < len(names) or "\n" in "".join(map("".join, pairs)):
            raise _core.InputError(f'The columns of "{name}" are {columns!r}; give a list of names, each of one line, once, and not '
                                   '"step" or "time".')
        if name in self._observers:
            raise _core.InputError(f'There is an observer "{name}" already; give this one another name.')
        self._observers[name] = (function, pairs)
        try:
            self._begin(name)
        except Exception:
            del self._observers[name]
            raise

    @property
    def dimension(self) -> int:
        """2 or 3."""
        return self._core.dimension

    @property
    def time(self) -> float:
        """Time of the present state [s]."""
        return self._core.time

    @property
    def time_step(self) -> float:
        """Length of the last step [s]; 0 before the first."""
        return self._core.time_step

    @property
    def n_steps(self) -> int:
        """Steps taken, those before a restart too."""
        return self._core.n_steps

    @property
    def history(self) -> Dict[str, Any]:
        """The last step's row of history.csv by column: momentum_error, s2_iterations, ... Empty before the first step."""
        return Named("column", self._core.history())

    @property
    def grid(self) -> Grid:
        """The box of cells that `fields` are on."""
        cells, spacing, origin = self._core.grid()
        return Grid(tuple(cells), np.array(spacing), np.array(origin))

    def bodies(self) -> Dict[str, Dict[str, Any]]:
        """Numbers of each solid, by name; d is the dimension, r = 1 in 2D and 3 in 3D.

        position, of the centre of mass [m], (d,); velocity [m/s], (d,); angular_velocity [rad/s], (r,); orientation, the rotation
        matrix from the axes in which its shape was given to those of space, (d, d), None if it is not rigid; force [N], (d,), and
        torque about the centre of mass [N m], (r,), of the fluid, contact_force and contact_torque, of contacts and limits of joints,
        all means over the last step as in bodies.csv, 0 before it; mass [kg], 0 if prescribed; volume [m^d]; kinetic_energy and
        elastic_energy [J].
        """
        return Named("solid", {name: Named("number of a solid", body) for name, body in self._core.bodies().items()})

    def joints(self) -> Dict[str, List[Dict[str, Any]]]:
        """Coordinates of each joint, by its name, a dictionary each.

        q [rad, m], rate, target (at the present time), torque [N m, N], power [W], limit_torque, gap, at_limit; see joints.csv. Torques
        and power are those of the last step, 0 before the first one.
        """
        return Named("joint", self._core.joints())

    def surfaces(self) -> Dict[str, Tuple[np.ndarray, np.ndarray]]:
        """Vertices [m], (n, d), and simplices, (m, corners) numbers of vertices, of solids and water, by name.

        A soft solid has its inside as "NAME elements". Those of rank 0 are whole.
        """
        return Named("surface", self._core.surfaces())

    def surface(self, name: str) -> Tuple[np.ndarray, np.ndarray]:
        """Vertices [m], (n, d), and simplices, (m, d) numbers of vertices, of one surface."""
        return self.surfaces()[name]

    def nodes(self, name: str) -> np.ndarray:
        """Positions of the nodes of a solid [m], (n, d): those inside too if it is soft, in the order of its mesh."""
        surfaces = self.surfaces()
        insides = [f"{solid} elements" for solid in surfaces]
        solids = Named("solid", {solid: surfaces.get(f"{solid} elements", surface) for solid, surface in surfaces.items() if solid not in insides})
        return solids[name][0]

    def fields(self) -> Dict[str, np.ndarray]:
        """All fields of a frame by name, on the cells of the whole box: velocity [m/s], pressure [Pa], ...

        Arrays [z][y][x] (2D: [y][x]), of `grid.shape`, vectors with their components last.
        """
        return Named("field", self._core.fields())

    def sample(self, points: "Union[np.ndarray, Sequence[Sequence[float]]]") -> Tuple[np.ndarray, np.ndarray, np.ndarray]:
        """The fluid at points, (n, d) [m]: whether it is there, (n,), its pressure [Pa], (n,), and its velocity [m/s], (n, d).

        In solids it is not there, and numbers are 0. A point outside of the domain, but for periodic sides, raises InputError.
        """
        return self._core.sample(points)

    def set_force(self, body: str, force: Numbers, torque: Numbers = 0.) -> None:
        """Pushes a rigid body from the next step on, until set again, instead of the scene's loads.

        force: at the centre of mass [N], (d,). torque: about it [N m], a number in 2D, (3,) in 3D. The ledger counts both.
        """
        turning = numbers(torque)
        if turning == [0.] and self.dimension == 3:
            turning = [0., 0., 0.]
        self._core.set_force(body, numbers(force), turning)

    def set_target(self, joint: str, q: Numbers, rate: Numbers = 0.) -> None:
        """Moves the target of a joint under control from the next step on, until set again: it is at q now and goes on with `rate`.

        q [rad, m], rate [rad/s, m/s]: a number, or one for each coordinate. "NAME 2" is the second coordinate of the joint NAME alone,
        if it is not that of a ball.
        """
        place, speed = numbers(q), numbers(rate)
        self._core.set_target(joint, place, [0.] * len(place) if speed == [0.] else speed)

    def _begin(self, name: str) -> None:
        row = self._row(name)  # before there is a table, as it may be refused
        if self._core.add_table(name, self._observers[name][1]):
            self._core.append_row(name, row)

    def _row(self, name: str) -> List[float]:
        function, columns = self._observers[name]
        row = numbers(function(self))
        if len(row) != len(columns):
            raise _core.InputError(f'The observer "{name}" has returned {len(row)} numbers; it has {len(columns)} columns.')
        for number, (column, _) in zip(row, columns):
            if not math.isfinite(number):
                raise _core.OutputError(f'The observer "{name}" has returned {number} for its column "{column}".')
        return row

    def _forget(self) -> None:
        """Functions often hold the run that holds them."""
        self._callbacks.clear()
        self._observers.clear()
