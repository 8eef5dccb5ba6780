"""Judges what damage left of a file, by readers of its own, and so whether a program has to refuse it.

Each judge takes the bytes before and after, and returns a word for what is left and one of MUST, MAY, NOT: the file must be
refused, may be, or may not be, since nothing changed.
"""
import functools
import io
import math
import re
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import h5py
import numpy

import mesh_readers

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "errors"))
from program import with_checksum, without_checksum  # noqa: E402

SOURCE = Path(__file__).resolve().parents[2]
MUST, MAY, NOT = "must be refused", "may be refused", "may not be refused"
SAME = ("the same", NOT)
OTHER_VALUE = ("another value", MAY)
# Lists whose entries users name, by the name of the list.
FREE_LISTS = {"Constants", "Solids", "Joints", "Observers", "Liquid", "Bubbles", "Watch", "Sources", "Regions", "Attachments",
              "Pinned", "Overrides", "Defaults", "Skins", "Parameters", "Series", "Quantities"}
NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?")
ORIGIN = ("@commit", "@scene", "@parameters")  # where a file comes from, for people
CHECKSUM_WORDS = b"\nLockstep CRC-32 "
TYPES = {"double", "int", "bool", "string", "Array(double)", "Array(int)", "Array(string)"}


class Faulty(Exception):
    """A fault of what is left that no valid file has; its text names the kind."""


@functools.lru_cache
def known_names():
    """All names of the reference, docs/parameters, and of the shipped files."""
    names = set()
    for page in (SOURCE / "docs/parameters").glob("*.md"):
        text = page.read_text()
        names.update(re.findall(r"^\| ([^|]+?) \|", text, re.MULTILINE))
        names.update(part for heading in re.findall(r"^#+ (.+)$", text, re.MULTILINE) for part in heading.split("/"))
    for path in (SOURCE / "xml-params").rglob("*.xml"):
        for parent in ElementTree.parse(path).iter("ParameterList"):
            names.update(child.get("name") for child in parent if parent.get("name") not in FREE_LISTS)
    return names


def check_number(text, whole):
    """A formula in brackets may be anything."""
    if text.startswith("[") and text.endswith("]"):
        return
    if not NUMBER.fullmatch(text) or whole and not re.fullmatch(r"[-+]?\d+", text):
        raise Faulty("a value that is none of its type")
    value = float(text)
    if not math.isfinite(value) or whole and abs(value) > 2 ** 31:
        raise Faulty("a number without bounds")


def check_value(kind, text):
    """Raises Faulty for text that the type cannot hold."""
    if kind not in TYPES:
        raise Faulty("an unknown type")
    text = text if kind == "string" else text.strip(" \t\r\n")
    if kind in ("double", "int"):
        check_number(text, kind == "int")
    elif kind == "bool" and text not in ("true", "yes", "1", "false", "no", "0") and not text.startswith("["):
        raise Faulty("a value that is none of its type")
    elif kind.startswith("Array"):
        if not (text.startswith("{") and text.endswith("}")) or "{" in text[1:] or "}" in text[:-1]:
            raise Faulty("a value that is none of its type")
        if "double" in kind or "int" in kind:
            for part in filter(None, [text[1:-1].strip()] if "[" in text else text[1:-1].split(",")):
                if "[" not in part:
                    check_number(part.strip(" \t\r\n"), "int" in kind)


def parameters_of(item, path=()):
    """All that a file says, as {path: (type, value)}; a list has no value. Raises Faulty."""
    found = {}
    for child in item:
        attributes = {"Parameter": ["name", "type", "value"], "ParameterList": ["name"]}.get(child.tag)
        if sorted(child.attrib) != attributes or not child.get("name") or child.tag == "Parameter" and len(child):
            raise Faulty("what is no parameter")
        here = (*path, child.get("name"))
        if here in found:
            raise Faulty("a name given twice")
        if child.tag == "ParameterList":
            found[here] = None
            found.update(parameters_of(child, here))
        else:
            check_value(child.get("type"), child.get("value"))
            found[here] = (child.get("type"), child.get("value"))
    return found


def is_misspelt(path):
    return path[-1] not in known_names() and not (len(path) > 1 and path[-2] in FREE_LISTS)


def judge_parameters(before, after):
    """Files of parameters in XML."""
    old = parameters_of(ElementTree.fromstring(before))
    try:
        root = ElementTree.fromstring(after)
    except (ElementTree.ParseError, ValueError, LookupError):
        return "no XML", MUST
    try:
        if root.tag != "ParameterList" or set(root.attrib) - {"name"} or any((text or "").strip() for item in root.iter() for text in (item.text, item.tail)):
            raise Faulty("what is no parameter")
        new = parameters_of(root)
    except Faulty as fault:
        return str(fault), MUST
    if new == old:
        return SAME
    if any(is_misspelt(path) for path in new.keys() - old.keys()):
        return "a misspelt name", MUST
    if new.keys() - old.keys():
        return "a name of another place", MAY
    if old.keys() - new.keys():
        return "less than before", MAY
    if any((new[path] or [None])[0] != (old[path] or [None])[0] for path in new):
        return "another type", MAY
    return OTHER_VALUE


def judge_bytes(before, after):
    """Files that end with a checksum."""
    return SAME if before == after else ("other bytes", MUST)


def judge_mesh(kind, before, after):
    """Meshes of bodies: surfaces (obj, off, stl) must be closed, elements (msh, vtk) have corners."""
    read, text = mesh_readers.READERS[kind], after.decode(errors="replace")
    try:
        vertices, simplices = read(text)
    except (ValueError, IndexError):
        return "no such mesh", MUST
    old_vertices, old_simplices = read(before.decode())
    if (vertices, simplices) == (old_vertices, old_simplices):
        return SAME if before == after else ("the same mesh, another text", MAY)
    if any(not 0 <= v < len(vertices) for simplex in simplices for v in simplex):
        return "a corner that is no vertex", MUST
    if kind in ("obj", "off", "stl") and not mesh_readers.is_closed(simplices):
        return "an open surface", MUST
    return ("other coordinates", MAY) if simplices == old_simplices else ("other elements", MAY)


def hdf5_content(data):
    """Datasets and attributes by their path, with their types; nothing for a group."""
    found = {}

    def read(name, item):
        found[name] = (item.dtype, numpy.asarray(item[()])) if isinstance(item, h5py.Dataset) else None
        for key, value in item.attrs.items():
            found[f"{name}@{key}"] = (item.attrs.get_id(key).dtype, numpy.asarray(value))

    with h5py.File(io.BytesIO(data), "r") as file:
        read("", file)
        file.visititems(read)
    return found


def judge_hdf5(before, after):
    """Files in HDF5 whose structure is whole."""
    old, new = hdf5_content(before), hdf5_content(after)
    for name in ORIGIN:
        old.pop(name, None), new.pop(name, None)
    gone = old.keys() ^ new.keys()
    if gone and all(name.startswith("@last look of ") for name in gone):
        return "no word of an observer", MAY  # as where a run goes on with one more observer
    if gone:
        return "less than before", MUST
    left = [judge_values(old[name], new[name]) for name in old if old[name] is not None]
    return min(left, key=lambda judgement: [MUST, MAY, NOT].index(judgement[1]))


def judge_values(typed_old, typed_new):
    (old_type, old), (new_type, new) = typed_old, typed_new
    if (old_type.kind in "OS") != (new_type.kind in "OS"):
        return "text for numbers, or numbers for text", MUST
    if old.shape != new.shape:
        is_text = old_type.kind in "OS" and old.size == new.size and old.flat[0] == new.flat[0]
        return ("the same text in another shape", MAY) if is_text else ("another shape", MUST)
    if old_type == new_type and old.tobytes() == new.tobytes():
        return SAME
    if new_type.kind in "OS":
        return "another text", MAY
    if not numpy.isfinite(new).all():
        return "a number without bounds", MUST
    return OTHER_VALUE


def judge_sealed_again(before, after):
    return judge_hdf5(without_checksum(before), without_checksum(after))


def judge_system(before, after):
    """Systems may lack their checksum, and then nothing tells damage from values."""
    if before == after:
        return SAME
    if with_checksum(without_checksum(after)) == after:
        return judge_sealed_again(before, after)
    return ("other bytes", MUST) if CHECKSUM_WORDS in after[-100:] else ("no checksum", MAY)
