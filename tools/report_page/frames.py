"""The frames of a run for the player of the page: surfaces, water, and fields in all cells or in some layers."""
import itertools

import numpy

from lockstep_frames import FramesError, NoFrames, read_frames

from report_page.blobs import pack_points, pack_simplices, pack_values

WATER = "water"
NOT_SHOWN = ("fluid", "phi")  # fields that say where fluid is
MOST_FIELD_BYTES = 48_000_000
CLOUDY = ("smoke", "temperature")  # fields that are shown as clouds; coarsely if they are too large
MOST_CLOUD_BYTES = 24_000_000
N_LAYERS = 3                  # layers of each axis, of a field that is too large


def written_at(frame):
    """When the file of a frame was written: one of an earlier run may have had the same time."""
    arrays = [array for grid in frame.grids for array in (grid.vertices, *(field[0] for field in grid.fields.values()))]
    path = next((array.path for array in arrays if array is not None and array.in_file), None)
    return path.stat().st_mtime_ns if path and path.is_file() else 0


def coarsened(values, by):
    """Means over blocks of `by` cells along each axis, of those that have a value; nan where none has."""
    padded = numpy.pad(values, [(0, -n % by) for n in values.shape], constant_values=numpy.nan)
    blocks = padded.reshape([length for n in padded.shape for length in (n // by, by)])
    axes = tuple(range(1, blocks.ndim, 2))
    n_known = numpy.isfinite(blocks).sum(axis=axes)
    return numpy.where(n_known, numpy.nansum(blocks, axis=axes) / numpy.maximum(n_known, 1), numpy.nan)


class FramePacker:
    """Packs frames once: those of a run that goes on are asked for again and again, and one that cannot be read is about to be
    replaced. Else (`is_done`) it is damaged."""

    def __init__(self, blobs, most_frames, fields=None, is_done=False):
        self.blobs, self.most_frames, self.fields, self.is_done = blobs, most_frames, fields, is_done
        self._packed, self._coarsening = {}, 1

    def pack(self, folder):
        """All frames of the folder (every nth of very many); an empty list if there are none yet."""
        try:
            frames = read_frames(folder)
        except FramesError as error:
            if self.is_done and not isinstance(error, NoFrames):
                raise
            return {"frames": [], "n_written": 0}
        every = -(-len(frames) // self.most_frames)
        chosen = [frame for i, frame in enumerate(frames) if i % every == 0 or i == len(frames) - 1]
        whole = self._whole_fields(frames[-1], len(chosen))
        self._coarsening = self._coarsening_for(frames[-1], len(chosen))
        packed = [self._frame(frame, whole) for frame in chosen]
        return {"frames": [frame for frame in packed if frame], "n_written": len(frames), "every": every}

    def _names(self, box):
        names = self.fields or [name for name in box.fields if name not in NOT_SHOWN]
        telling = [word for word in ("smoke", "velocity", "pressure", "temperature") if word in names]
        return [name for name in telling + [name for name in names if name not in telling] if name in box.fields]

    def _whole_fields(self, frame, n_frames):
        """Names of the fields that are small enough to be taken in all cells, the most telling first."""
        whole, left = set(), MOST_FIELD_BYTES
        for box in frame.boxes[:1]:
            for name in self._names(box):
                size = numpy.prod(box.n_cells) * n_frames
                if size <= left or box.dim == 2:
                    whole.add(name)
                    left -= size
        return whole

    @staticmethod
    def _coarsening_for(frame, n_frames):
        """Cells along each axis that a cell of a cloud stands for, so that clouds keep to their bytes."""
        cells = numpy.array(frame.boxes[0].n_cells if frame.boxes else [1])
        return next(by for by in itertools.count(1) if numpy.prod(-(-cells // by)) * n_frames <= max(MOST_CLOUD_BYTES, n_frames))

    def _frame(self, frame, whole):
        key = (frame.time, written_at(frame), frozenset(whole), self._coarsening)
        if key not in self._packed:
            try:
                self._packed[key] = self._pack(frame, whole)
            except FramesError:
                if self.is_done:
                    raise
                return None
        return self._packed[key]

    def _pack(self, frame, whole):
        packed = {"time": frame.time, "surfaces": [], "fields": {}}
        for surface in frame.surfaces:
            packed["surfaces"].append({"name": surface.name, "water": surface.name == WATER,
                                       "corners": surface.n_corners,
                                       "points": pack_points(self.blobs, surface.points()),
                                       "simplices": pack_simplices(self.blobs, surface.cells())})
        for box in frame.boxes[:1]:
            packed["box"] = {"origin": box.origin.tolist(), "spacing": box.spacing.tolist(), "cells": box.n_cells}
            none = self._without_fluid(box)
            for name in self._names(box):
                packed["fields"][name] = self._field(box, name, none, name in whole)
        return packed

    @staticmethod
    def _without_fluid(box):
        """Cells without values: those in solids and, above a liquid's surface, in air without mass."""
        none = numpy.zeros(box.n_cells[::-1], bool)
        if "fluid" in box.fields:
            none |= box.values("fluid").reshape(none.shape) == 0
        elif "phi" in box.fields:
            none |= box.values("phi").reshape(none.shape) >= 0
        return none

    def _field(self, box, name, none, is_whole):
        is_vector = box.fields[name][2]
        values = box.values(name).astype(float)
        if is_vector:
            values = numpy.linalg.norm(values, axis=-1)
        values = values.reshape(box.n_cells[::-1])
        values = numpy.where(none, numpy.nan, values)
        known = values[numpy.isfinite(values)]
        # A few cells beyond the range must not take the colours of all others.
        low, high = numpy.percentile(known, (0.1, 99.9)) if known.size else (0.0, 1.0)
        high = high if high > low else low + max(abs(low), 1) * 1e-6
        packed = {"low": float(low), "high": float(high), "magnitude": is_vector}
        if is_whole:
            packed["blob"] = pack_values(self.blobs, values, low, high)
        else:
            packed["layers"] = [self._layers(values, axis, low, high) for axis in range(3)]
            if name in CLOUDY:
                coarse = coarsened(values, self._coarsening)
                packed["volume"] = {"blob": pack_values(self.blobs, coarse, low, high), "cells": list(coarse.shape[::-1]),
                                    "by": self._coarsening}
        return packed

    def _layers(self, values, axis, low, high):
        """Some layers across an axis, each as its number and its values with the other axes in their order."""
        n = values.shape[2 - axis]
        numbers = sorted({min(n - 1, n * (k + 1) // (N_LAYERS + 1)) for k in range(N_LAYERS)})
        return [{"layer": k, "blob": pack_values(self.blobs, numpy.take(values, k, axis=2 - axis), low, high)}
                for k in numbers]
