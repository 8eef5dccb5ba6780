"""Small meshes as the texts of the files that scenes can name."""
import math


def icosahedron(radius):
    """Vertices and outward triangles."""
    golden = (1 + math.sqrt(5)) / 2
    vertices = []
    for a, b in ((1, golden), (-1, golden), (1, -golden), (-1, -golden)):
        vertices += [(0, a, b), (a, b, 0), (b, 0, a)]
    scale = radius / math.hypot(1, golden)
    vertices = [tuple(scale * x for x in v) for v in vertices]
    edge = 2 * scale * 1.001
    near = lambda i, j: math.dist(vertices[i], vertices[j]) < edge
    triangles = []
    for i in range(12):
        for j in range(i + 1, 12):
            for k in range(j + 1, 12):
                if near(i, j) and near(j, k) and near(i, k):
                    triangles.append(outward(vertices, (i, j, k)))
    return vertices, triangles


def outward(vertices, triangle):
    """The triangle turned so that its normal points away from the origin."""
    a, b, c = (vertices[v] for v in triangle)
    u, v = [y - x for x, y in zip(a, b)], [y - x for x, y in zip(a, c)]
    normal = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
    return triangle if sum(n * (x + y + z) for n, x, y, z in zip(normal, a, b, c)) > 0 else triangle[::-1]


def polygon(radius, n):
    """Vertices and segments of a convex polygon whose inside lies to their left."""
    vertices = [(radius * math.cos(2 * math.pi * k / n), radius * math.sin(2 * math.pi * k / n)) for k in range(n)]
    return vertices, [(k, (k + 1) % n) for k in range(n)]


def obj(vertices, simplices):
    word = "l" if len(vertices[0]) == 2 else "f"
    lines = ["v " + " ".join(map(repr, [*v, *[0.0] * (3 - len(v))])) for v in vertices]
    return "\n".join(lines + [" ".join([word, *(str(v + 1) for v in s)]) for s in simplices]) + "\n"


def off(vertices, simplices):
    lines = ["OFF", f"{len(vertices)} {len(simplices)} 0"]
    lines += [" ".join(map(repr, [*v, *[0.0] * (3 - len(v))])) for v in vertices]
    return "\n".join(lines + [" ".join(map(str, [len(s), *s])) for s in simplices]) + "\n"


def stl(vertices, triangles):
    lines = ["solid body"]
    for triangle in triangles:
        lines += ["facet normal 0 0 0", "outer loop"]
        lines += ["vertex " + " ".join(map(repr, vertices[v])) for v in triangle]
        lines += ["endloop", "endfacet"]
    return "\n".join(lines + ["endsolid body"]) + "\n"


def filled(vertices, simplices):
    """Volume elements: every simplex of a star-shaped surface joined to the origin."""
    return [*vertices, (0.0,) * len(vertices[0])], [(*s, len(vertices)) for s in simplices]


def gmsh(vertices, elements, dimension):
    """Version 2.2 with triangles (2D) or tetrahedra (3D)."""
    kind = {2: 2, 3: 4}[dimension]
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$Nodes", str(len(vertices))]
    lines += [" ".join([str(k + 1), *map(repr, [*v, *[0.0] * (3 - len(v))])]) for k, v in enumerate(vertices)]
    lines += ["$EndNodes", "$Elements", str(len(elements))]
    lines += [" ".join(map(str, [k + 1, kind, 2, 0, 0, *(v + 1 for v in e)])) for k, e in enumerate(elements)]
    return "\n".join(lines + ["$EndElements"]) + "\n"


def vtk(vertices, elements, dimension):
    """Legacy ASCII with triangles (2D) or tetrahedra (3D)."""
    lines = ["# vtk DataFile Version 2.0", "a body", "ASCII", "DATASET UNSTRUCTURED_GRID",
             f"POINTS {len(vertices)} double"]
    lines += [" ".join(map(repr, [*v, *[0.0] * (3 - len(v))])) for v in vertices]
    lines += [f"CELLS {len(elements)} {len(elements) * (dimension + 2)}"]
    lines += [" ".join(map(str, [dimension + 1, *e])) for e in elements]
    lines += [f"CELL_TYPES {len(elements)}"] + [str({2: 5, 3: 10}[dimension])] * len(elements)
    return "\n".join(lines) + "\n"
