"""Readers of the mesh files that mesh_files.py writes, by which meaning.py judges damaged ones. They know no more of the
formats than that needs, and raise ValueError or IndexError where a file is none."""
import math


def vertex(words):
    point = tuple(float(word) for word in words[:3])
    if len(point) < 3 or not all(map(math.isfinite, point)):
        raise ValueError("a vertex has three finite numbers")
    return point


def rows(text):
    return [line.split() for line in text.splitlines() if line.strip() and not line.startswith("#")]


def obj(text):
    vertices, simplices = [], []
    for words in rows(text):
        if words[0] == "v":
            vertices.append(vertex(words[1:]))
        elif words[0] in ("f", "l"):
            simplices.append(tuple(int(word) - 1 for word in words[1:]))
    return vertices, simplices


def off(text):
    lines = rows(text)
    n_vertices, n_simplices = int(lines[1][0]), int(lines[1][1])
    if lines[0] != ["OFF"] or min(n_vertices, n_simplices) < 0:
        raise ValueError("no OFF")
    vertices = [vertex(lines[2 + k]) for k in range(n_vertices)]
    simplices = [tuple(map(int, lines[2 + n_vertices + k])) for k in range(n_simplices)]
    if any(simplex[0] != len(simplex) - 1 for simplex in simplices):
        raise ValueError("a face of another size than it says")
    return vertices, [simplex[1:] for simplex in simplices]


def stl(text):
    corners = [vertex(words[1:]) for words in rows(text) if words[0] == "vertex"]
    numbers = {}
    for corner in corners:
        numbers.setdefault(corner, len(numbers))
    if len(corners) % 3:
        raise ValueError("a facet without three corners")
    return list(numbers), [tuple(numbers[corner] for corner in corners[k:k + 3]) for k in range(0, len(corners), 3)]


def msh(text):
    lines = rows(text)
    nodes, elements = lines.index(["$Nodes"]), lines.index(["$Elements"])
    points = {int(words[0]): vertex(words[1:]) for words in lines[nodes + 2:nodes + 2 + int(lines[nodes + 1][0])]}
    numbers = {name: k for k, name in enumerate(points)}
    simplices = [tuple(numbers.get(int(word), -1) for word in words[3 + int(words[2]):])
                 for words in lines[elements + 2:elements + 2 + int(lines[elements + 1][0])]]
    return list(points.values()), simplices


def vtk(text):
    lines = text.splitlines()
    heads = [line.split(maxsplit=1)[0] if line.strip() else "" for line in lines]
    points, cells = heads.index("POINTS"), heads.index("CELLS")
    vertices = [vertex(line.split()) for line in lines[points + 1:points + 1 + int(lines[points].split()[1])]]
    simplices = [tuple(map(int, line.split()[1:])) for line in lines[cells + 1:cells + 1 + int(lines[cells].split()[1])]]
    return vertices, simplices


def is_closed(simplices):
    """Each edge of a triangle is passed once in either direction, each end of a segment once."""
    if all(len(simplex) == 2 for simplex in simplices):
        begins, ends = sorted(a for a, _ in simplices), sorted(b for _, b in simplices)
        return begins == ends and len(set(begins)) == len(begins)
    edges = [(simplex[k - 1], simplex[k]) for simplex in simplices for k in range(len(simplex))]
    return len(set(edges)) == len(edges) and all((b, a) in set(edges) for a, b in edges)


READERS = {"obj": obj, "off": off, "stl": stl, "msh": msh, "vtk": vtk}
