"""Reads the frames of a run from its frames.xmf: names, times, geometry and where each array lies.

    for frame in read_frames("output/run"):
        ball, box = frame["Ball"], frame["fluid"]
        print(frame.time, ball.points().mean(axis=0), box.values("pressure").max())

Only the index is read at once; arrays are opened when asked for. All of tools/ reads frames with this; a program of one's
own may have a copy of this file, which needs h5py and numpy alone.
"""
import math
import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass, field
from pathlib import Path

import h5py
import numpy


ELEMENTS = " elements"  # the mesh of the solid "Flag" is "Flag elements"


class FramesError(Exception):
    """The run's folder lacks something, or something in it is damaged; the message says what and where."""


class NoFrames(FramesError):
    """The run has written none, or none yet."""


# Exceptions of h5py and numpy at damaged files: which of them is a matter of where the damage is.
DAMAGES = (OSError, KeyError, ValueError, TypeError, RuntimeError, OverflowError)


@dataclass
class Array:
    """A DataItem: a dataset in an HDF5 file, or numbers written in the XML itself."""
    text: str
    folder: Path
    in_file: bool
    n_values: int

    def read(self, selection=()):
        """The values, or only those of a selection such as (3, slice(None))."""
        if not self.in_file:
            return numpy.array(self.text.split(), dtype=float)[selection]
        return self._with_dataset(lambda dataset: dataset[selection])

    def check(self):
        """Throws FramesError unless the values are there, without reading them."""
        if self.in_file:
            self._with_dataset(lambda dataset: None)

    def _with_dataset(self, function):
        name = self.text.strip().rsplit(":", 1)[1]
        if not self.path.is_file():
            raise FramesError(f"{self.path}, which frames.xmf names, is not there; was it moved or removed?")
        try:
            with h5py.File(self.path, "r") as file:
                dataset = file.get(name)
                if not isinstance(dataset, h5py.Dataset):
                    raise FramesError(f"{self.path} holds no dataset '{name}', which frames.xmf names; the files are of two runs, or damaged.")
                if dataset.dtype.kind not in "fiu" or dataset.size != self.n_values:
                    what = f"{dataset.size or 0} values" if dataset.dtype.kind in "fiu" else "no numbers"
                    raise FramesError(f"{self.path}: '{name}' holds {what}, but frames.xmf says {self.n_values} numbers; "
                                      "the files are of two runs, or damaged.")
                return function(dataset)
        except DAMAGES as error:
            reason = " ".join(str(error).split())
            raise FramesError(f"{self.path}: cannot read '{name}'; the file is cut short, damaged or no HDF5 file ({reason}).") from error

    @property
    def path(self):
        """Path of the HDF5 file."""
        return self.folder / self.text.strip().rsplit(":", 1)[0]


@dataclass
class Grid:
    """A fluid box (cell values in fields) or a solid's surface or volume (simplices over vertices)."""
    name: str
    is_box: bool
    dim: int
    n_corners: int = 0                          # corners of a simplex
    fields: dict = field(default_factory=dict)  # name -> (Array, "Cell" or "Node", is a vector)
    origin: numpy.ndarray = None                # origin of a box, in x, y, z order
    spacing: numpy.ndarray = None
    n_cells: list = None                        # in x, y, z order; 1 along z in two dimensions
    vertices: Array = None                      # vertices of a surface
    simplices: Array = None

    def points(self):
        """Positions of a surface or volume (n, 3) [m]; z is 0 in two dimensions."""
        return self.vertices.read()

    def cells(self):
        """Vertex numbers of a surface or volume (n, corners)."""
        cells = self.simplices.read().astype(int).reshape(-1, self.n_corners)
        n_vertices = self.vertices.n_values // 3
        if cells.size and (cells.min() < 0 or cells.max() >= n_vertices):
            raise FramesError(f"{self.simplices.path}: '{self.name}' has the vertex number {cells.max() if cells.min() >= 0 else cells.min()}, "
                              f"but {n_vertices} vertices, from 0; the file is damaged.")
        return cells

    def centres(self):
        """Centres of a box's cells: their x, their y and their z [m]."""
        return [self.origin[axis] + self.spacing[axis] * (numpy.arange(n) + 0.5) for axis, n in enumerate(self.n_cells)]

    def values(self, name):
        """A field: of a box [z][y][x] (in 2D [y][x]), of a surface or volume one a cell; vectors have one more index."""
        if name not in self.fields:
            raise FramesError(f"'{self.name}' has no field '{name}'; there are: {', '.join(self.fields) or 'none'}.")
        return self.fields[name][0].read()


@dataclass
class Frame:
    time: float
    grids: list

    def __getitem__(self, name):
        """The grid of that name: "fluid", a solid, "SOLID elements", "water" or "drops"."""
        for grid in self.grids:
            if grid.name == name:
                return grid
        raise FramesError(f"The frame at {self.time:g} s holds no '{name}', but {', '.join(self.names)}.")

    @property
    def names(self):
        return [grid.name for grid in self.grids]

    def check(self):
        """Throws FramesError unless all arrays of the frame can be read: for programs that read the files themselves."""
        for grid in self.grids:
            for array in (grid.vertices, grid.simplices, *(field[0] for field in grid.fields.values())):
                if array is not None:
                    array.check()

    @property
    def boxes(self):
        return [grid for grid in self.grids if grid.is_box]

    @property
    def surfaces(self):
        """Surfaces of all solids, one each, and of water; not the elements of deformable solids, whose surfaces are there too."""
        return [grid for grid in self.grids if not grid.is_box and grid.n_corners > 1 and not self._is_elements(grid)]

    @property
    def points(self):
        """Drops of water: points with radii, if there are any."""
        return [grid for grid in self.grids if grid.n_corners == 1]

    @property
    def elements(self):
        """The elements of deformable solids, by the name of the solid."""
        return {grid.name[:-len(ELEMENTS)]: grid for grid in self.grids if self._is_elements(grid)}

    def _is_elements(self, grid):
        return grid.name.endswith(ELEMENTS) and grid.name[:-len(ELEMENTS)] in self.names


def index_path(output_directory):
    path = Path(output_directory) / "frames.xmf"
    if not path.is_file():
        raise NoFrames(f"{output_directory} holds no frames.xmf: is it the output folder of a run?")
    return path.resolve()


def read_frames(output_directory):
    """The frames of a run in the order of time."""
    path = index_path(output_directory)
    try:
        tree = ElementTree.parse(path)
    except ElementTree.ParseError as error:
        raise FramesError(f"{path} is not proper XML: {error}.") from error
    frames = []
    try:
        for collection in tree.getroot().iter("Grid"):
            if collection.get("CollectionType") == "Temporal":
                frames += [_frame(element, path.parent) for element in collection.findall("Grid")]
    except (AttributeError, *DAMAGES) as error:
        raise FramesError(f"{path} is no index of frames as a run writes it ({error}); is it damaged?") from error
    if not frames:
        raise NoFrames(f"{path} lists no frame: the run wrote none yet.")
    return sorted(frames, key=lambda frame: frame.time)


def _frame(element, folder):
    time = element.find("Time")
    leaves = [grid for grid in element.iter("Grid") if grid.get("GridType", "Uniform") == "Uniform"]
    return Frame(float(time.get("Value")) if time is not None else 0.0,
                 [_grid(leaf, folder) for leaf in leaves])


def _array(item, folder):
    sizes = [int(word) for word in item.get("Dimensions").split()]
    array = Array(item.text, folder, item.get("Format", "XML") == "HDF", math.prod(sizes))
    if array.in_file and ":" not in array.text:
        raise ValueError(f"'{array.text.strip()[:60]}' names no dataset")
    return array


def _grid(element, folder):
    topology, geometry = element.find("Topology"), element.find("Geometry")
    kind = topology.get("TopologyType") or topology.get("Type")
    items = geometry.findall("DataItem")
    grid = Grid(element.get("Name"), "CoRectMesh" in kind, 2)
    if grid.is_box:
        # XDMF gives origin and spacing in the order of the array's indices: z first.
        grid.origin, grid.spacing = (_array(item, folder).read()[::-1] for item in items)
        nodes = [int(word) for word in topology.get("Dimensions").split()]
        grid.n_cells = [max(n - 1, 1) for n in reversed(nodes)] + [1] * (3 - len(nodes))
        grid.dim = 2 if grid.n_cells[2] == 1 else 3
    else:
        grid.n_corners = {"Polyvertex": 1, "Polyline": 2, "Triangle": 3, "Tetrahedron": 4}[kind]
        grid.dim = 2 if grid.n_corners == 2 else 3
        grid.vertices = _array(items[0], folder)
        grid.simplices = _array(topology.find("DataItem"), folder)
        _check_size(grid, "simplices", grid.simplices, int(topology.get("NumberOfElements")) * grid.n_corners)
        _check_size(grid, "vertices", grid.vertices, grid.vertices.n_values // 3 * 3)
    for attribute in element.findall("Attribute"):
        name, is_vector = attribute.get("Name"), attribute.get("AttributeType") == "Vector"
        values = _array(attribute.find("DataItem"), folder)
        if grid.is_box:
            _check_size(grid, name, values, math.prod(grid.n_cells) * (3 if is_vector else 1))
        grid.fields[name] = (values, attribute.get("Center", "Node"), is_vector)
    return grid


def _check_size(grid, name, array, n_values):
    if array.n_values != n_values:
        raise ValueError(f"'{name}' of '{grid.name}' has {array.n_values} values in place of {n_values}")


def choose_frame(frames, number=None, time=None):
    """The frame of that number (from 0, negative from the end), nearest to that time, or the last."""
    if number is not None:
        if not -len(frames) <= number < len(frames):
            raise FramesError(f"There is no frame {number}: the run has frames 0 to {len(frames) - 1}.")
        return number % len(frames)
    if time is not None:
        return min(range(len(frames)), key=lambda i: abs(frames[i].time - time))
    return len(frames) - 1


def choose_field(grid, name=None):
    """The name of a field of a box: the one asked for, or the first of the most telling ones."""
    if name is None:
        told = [key for word in ("smoke", "velocity", "pressure") for key in grid.fields if word in key.lower()]
        if not (told or grid.fields):
            raise FramesError(f"Grid '{grid.name}' has no field.")
        return told[0] if told else next(iter(grid.fields))
    if name not in grid.fields:
        raise FramesError(f"There is no field '{name}'; the run wrote: {', '.join(grid.fields)}.")
    return name
