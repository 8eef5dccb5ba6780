"""Mutators, which damage files. Each is a pure function of a random generator and the bytes of a file."""
import io
import re
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import h5py
import numpy

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "errors"))
from program import with_checksum, without_checksum  # noqa: E402

NUMBER = re.compile(rb"(?<![\w.])[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?(?![\w.])")
TEXTS = ["nan", "inf", "-inf", "1e308", "-1e308", "1e-308", "1e999", "0", "-0", "-1", "", "1e9", "2147483647", "-2147483648",
         "99999999999999999999", "0x10", "1,5", "abc", "{}", "{1}", "{1, 2, 3, 4}", "true", "1e-9", "-3.5"]
NUMBERS = [numpy.nan, numpy.inf, -numpy.inf, 1e308, -1e308, 1e-308, 0.0, -1.0, 1e30, 2147483647, -2147483648]


def place(rng, data):
    return rng.randrange(max(1, len(data)))


def flip_bytes(rng, data):
    changed = bytearray(data)
    for _ in range(rng.choice([1, 1, 4, 64])):
        if changed:
            changed[place(rng, data)] ^= 1 << rng.randrange(8)
    return bytes(changed)


def overwrite(rng, data):
    begin, n = place(rng, data), rng.choice([1, 8, 64])
    filler = rng.choice([b"\0" * n, b"\xff" * n, bytes(rng.randrange(256) for _ in range(n))])
    return data[:begin] + filler + data[begin + n:]


def truncate(rng, data):
    return data[:rng.choice([0, 1, place(rng, data), place(rng, data)])]


def drop_part(rng, data):
    begin = place(rng, data)
    return data[:begin] + data[begin + rng.choice([1, 10, 100]):]


def repeat_part(rng, data):
    begin = place(rng, data)
    end = begin + rng.choice([1, 10, 100])
    return data[:end] + data[begin:end] + data[end:]


def change_number(rng, data):
    found = list(NUMBER.finditer(data))
    if not found:
        return flip_bytes(rng, data)
    match = rng.choice(found)
    return data[:match.start()] + rng.choice(TEXTS).encode() + data[match.end():]


def change_lines(rng, data):
    """A line dropped, doubled, moved or cut."""
    lines = data.splitlines(keepends=True)
    if not lines:
        return data
    k = rng.randrange(len(lines))
    how = rng.randrange(4)
    if how == 0:
        del lines[k]
    elif how == 1:
        lines.insert(k, lines[k])
    elif how == 2:
        lines.insert(rng.randrange(len(lines)), lines.pop(k))
    else:
        lines[k] = lines[k][:place(rng, lines[k])] + b"\n"
    return b"".join(lines)


BYTES = [flip_bytes, overwrite, truncate, drop_part, repeat_part]
TEXT = [*BYTES, change_number, change_number, change_number, change_lines, change_lines]


def edit_xml(rng, data, edit):
    """`edit` changes one element, which it is given with its parent."""
    root = ElementTree.fromstring(data)
    pairs = [(parent, child) for parent in root.iter() for child in parent]
    if pairs:
        edit(rng, *rng.choice(pairs))
    return ElementTree.tostring(root, encoding="utf-8")


def drop_element(rng, data):
    return edit_xml(rng, data, lambda rng, parent, child: parent.remove(child))


def repeat_element(rng, data):
    return edit_xml(rng, data, lambda rng, parent, child: parent.append(child))


def rename_element(rng, data):
    def rename(rng, parent, child):
        name = child.get("name", "")
        child.set("name", rng.choice(["", name + "x", name[1:], name.upper(), "a/b", "\u00e4", name * 50, "Type"]))
    return edit_xml(rng, data, rename)


def retype_element(rng, data):
    def retype(rng, parent, child):
        if child.tag == "Parameter" and rng.random() < 0.8:
            child.set("type", rng.choice(["int", "double", "string", "bool", "Array(double)", "Array(int)", "float", ""]))
        else:
            child.tag = "Parameter" if child.tag == "ParameterList" else "ParameterList"
    return edit_xml(rng, data, retype)


def revalue_element(rng, data):
    def revalue(rng, parent, child):
        old = child.get("value", "")
        parts = re.split(r"(, |\{|\})", old)
        numbers = [k for k, part in enumerate(parts) if re.fullmatch(r"[-+.\deE]+", part)]
        if numbers and rng.random() < 0.8:
            parts[rng.choice(numbers)] = rng.choice(TEXTS)
            child.set("value", "".join(parts))
        else:
            child.set("value", rng.choice([*TEXTS, old + "x", old * 100]))
    return edit_xml(rng, data, revalue)


XML = [*TEXT, drop_element, drop_element, repeat_element, rename_element, rename_element, retype_element, retype_element,
       *[revalue_element] * 6]


def edit_hdf5(data, edit):
    """The file after `edit` changed it; h5py works on a copy in memory."""
    file = io.BytesIO(data)
    with h5py.File(file, "r+") as opened:
        edit(opened)
    return file.getvalue()


def objects(file, kind=None):
    found = []
    file.visititems(lambda name, item: found.append(name) if kind is None or isinstance(item, kind) else None)
    return found


def replace_dataset(file, name, values):
    attributes = dict(file[name].attrs)
    del file[name]
    file[name] = values
    for key, value in attributes.items():
        file[name].attrs[key] = value


def change_values(rng, data):
    """One number, or all of a dataset."""
    def change(file):
        name = rng.choice(objects(file, h5py.Dataset))
        values = file[name][()]
        if not isinstance(values, numpy.ndarray) or values.size == 0 or values.dtype.kind not in "fiu":
            replace_dataset(file, name, rng.choice(["", "text", 3]))
            return
        new = rng.choice(NUMBERS)
        with numpy.errstate(all="ignore"):
            new = numpy.array(new if values.dtype.kind == "f" else int(numpy.nan_to_num(new)) % 2 ** 31 - 2 ** 30).astype(values.dtype)
        if rng.random() < 0.5:
            values[...] = new
        else:
            values.flat[rng.randrange(values.size)] = new
        file[name][...] = values
    return edit_hdf5(data, change)


def change_shape(rng, data):
    """A dataset shortened, lengthened, emptied, flattened, or of another type."""
    def change(file):
        name = rng.choice(objects(file, h5py.Dataset))
        values = numpy.atleast_1d(file[name][()])
        how = rng.randrange(5)
        changed = [values[:-1], numpy.concatenate([values, values[:1]]), values[:0], values.ravel()[None],
                   values.astype("S8") if values.dtype.kind in "fiu" else numpy.zeros(3)][how]
        replace_dataset(file, name, changed)
    return edit_hdf5(data, change)


def drop_object(rng, data):
    def drop(file):
        name = rng.choice(objects(file))
        if rng.random() < 0.3:
            file.move(name, name + " x")
        else:
            del file[name]
    return edit_hdf5(data, drop)


def change_attribute(rng, data):
    def change(file):
        holders = [item for item in [file, *(file[name] for name in objects(file))] if len(item.attrs)]
        if not holders:
            return
        holder = rng.choice(holders)
        key = rng.choice(sorted(holder.attrs))
        if rng.random() < 0.25:
            del holder.attrs[key]
        else:
            holder.attrs[key] = rng.choice([*NUMBERS, "", "text", numpy.zeros(0), numpy.arange(7), -1, 0, 10 ** 12])
    return edit_hdf5(data, change)


def sealed_again(mutator):
    """Damages what the file holds; its last line, the checksum, is made anew."""
    def mutate(rng, data):
        return with_checksum(mutator(rng, without_checksum(data)))
    mutate.__name__ = mutator.__name__
    return mutate


RESEALED_HDF5 = [sealed_again(mutator) for mutator in
                 (change_values, change_values, change_values, change_shape, drop_object, change_attribute)]
HDF5 = [*BYTES, change_values, change_values, change_values, change_shape, change_shape, drop_object, change_attribute,
        change_attribute]


def mutated(rng, data, mutators):
    """The damaged file, mostly by one mutator, and their names. What XML cannot be parsed any more is damaged as text."""
    names = []
    for _ in range(rng.choice([1, 1, 1, 2])):
        mutator = rng.choice(mutators)
        try:
            data = mutator(rng, data)
        except (ElementTree.ParseError, OSError, OverflowError, IndexError, KeyError, ValueError, RuntimeError):
            mutator = overwrite
            data = mutator(rng, data)
        names.append(mutator.__name__)
    return data, " and ".join(names)
