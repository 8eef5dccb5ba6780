"""Arrays as the page takes them: bytes by the name of their content, so that what repeats is stored once."""
import base64
import hashlib
import zlib

import numpy


class Blobs:
    """Compressed bytes by name. Those of many frames stay small: a rigid mesh's triangles come once."""

    def __init__(self):
        self._compressed = {}

    def add(self, values):
        data = numpy.ascontiguousarray(values).tobytes()
        name = hashlib.sha1(data).hexdigest()[:16]
        if name not in self._compressed:
            self._compressed[name] = zlib.compress(data, 6)
        return name

    def __contains__(self, name):
        return name in self._compressed

    def __getitem__(self, name):
        return self._compressed[name]

    def as_text(self):
        """All of them, for a page that stands alone."""
        return {name: base64.b64encode(data).decode() for name, data in self._compressed.items()}


def pack_numbers(blobs, values):
    """Columns (n_columns, n_rows) in single precision."""
    return blobs.add(numpy.asarray(values, "<f4"))


def pack_points(blobs, points):
    """Positions (n, 3) as 16 bits between the corners of their box; differences, which compress better."""
    points = numpy.asarray(points, float).reshape(-1, 3)
    low = points.min(axis=0) if len(points) else numpy.zeros(3)
    size = points.max(axis=0) - low if len(points) else numpy.zeros(3)
    scaled = numpy.rint((points - low) / numpy.where(size > 0, size, 1) * 65535).astype("<u2")
    return {"blob": blobs.add(numpy.diff(scaled.T, axis=1, prepend=scaled.T[:, :1] * 0)), "n": len(points),
            "low": low.tolist(), "size": size.tolist()}


def pack_simplices(blobs, simplices):
    """Vertex numbers (n, corners) as differences of 32 bits."""
    flat = numpy.asarray(simplices).astype("<u4").reshape(-1)
    return {"blob": blobs.add(numpy.diff(flat, prepend=flat[:1] * 0)), "n": len(simplices)}


NO_VALUE = 255


def pack_values(blobs, values, low, high):
    """Numbers as 0 to 254 between low and high; 255: none (not a number)."""
    scaled = numpy.clip((values - low) / (high - low) * 254, 0, 254)
    return blobs.add(numpy.where(numpy.isnan(values), NO_VALUE, numpy.rint(scaled)).astype("u1"))
