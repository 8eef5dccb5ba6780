"""Writes a small output folder as a run would: two frames of a box of 8 x 6 x 4 cells (8 x 6 in 2D) with
smoke = x and a velocity, and one soft body: a tetrahedron (a square in 2D), as surface and as elements. Usage: make_frames.py DIR DIM"""
import sys
from pathlib import Path

import h5py
import numpy

H = 0.125
ORIGIN = (1.0, 0.0, -0.25)  # x, y, z


def write_fluid(file, group, dim, time):
    n = (8, 6, 4 if dim == 3 else 1)
    x = ORIGIN[0] + (numpy.arange(n[0]) + 0.5) * H
    file[f"{group}/smoke"] = numpy.broadcast_to(x + time, n[::-1]).astype("f4")
    velocity = numpy.zeros(n[::-1] + (3,), "f4")
    velocity[..., 1] = time
    file[f"{group}/velocity"] = velocity
    # ParaView lays a 2DCoRectMesh into the plane x = 0: in 2D, one layer of cells below z = 0 instead.
    nodes = " ".join(str(k + 1) for k in n[::-1])
    cells = " ".join(str(k) for k in n[::-1])
    origin = " ".join(str(o) for o in ((ORIGIN[2] if dim == 3 else -H), ORIGIN[1], ORIGIN[0]))
    return f"""
   <Grid Name="fluid" GridType="Uniform">
    <Topology TopologyType="3DCoRectMesh" Dimensions="{nodes}"/>
    <Geometry GeometryType="ORIGIN_DXDYDZ">
     <DataItem Dimensions="3" Format="XML">{origin}</DataItem>
     <DataItem Dimensions="3" Format="XML">{H} {H} {H}</DataItem>
    </Geometry>
    <Attribute Name="smoke" AttributeType="Scalar" Center="Cell">
     <DataItem Dimensions="{cells}" NumberType="Float" Precision="4" Format="HDF">frames.h5:{group}/smoke</DataItem>
    </Attribute>
    <Attribute Name="velocity" AttributeType="Vector" Center="Cell">
     <DataItem Dimensions="{cells} 3" NumberType="Float" Precision="4" Format="HDF">frames.h5:{group}/velocity</DataItem>
    </Attribute>
   </Grid>"""


def write_elements(file, group, n_vertices, dim):
    elements = numpy.array([(0, 2, 1, 3)] if dim == 3 else [(0, 1, 2), (0, 2, 3)], "i4")
    file[f"{group}/elements"] = elements
    kind = "Tetrahedron" if dim == 3 else "Triangle"
    return f"""
   <Grid Name="body elements" GridType="Uniform">
    <Topology TopologyType="{kind}" NumberOfElements="{len(elements)}">
     <DataItem Dimensions="{len(elements)} {dim + 1}" NumberType="Int" Format="HDF">frames.h5:{group}/elements</DataItem>
    </Topology>
    <Geometry GeometryType="XYZ">
     <DataItem Dimensions="{n_vertices} 3" NumberType="Float" Precision="8" Format="HDF">frames.h5:{group}/vertices</DataItem>
    </Geometry>
   </Grid>"""


def write_body(file, group, dim):
    if dim == 3:
        vertices = numpy.array([(1.25, 0.25, -0.2), (1.75, 0.25, -0.2), (1.5, 0.6, -0.2), (1.5, 0.4, 0.2)])
        simplices = numpy.array([(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)], "i4")
        topology = f'TopologyType="Triangle" NumberOfElements="{len(simplices)}"'
    else:
        vertices = numpy.array([(1.25, 0.25, 0), (1.5, 0.25, 0), (1.5, 0.5, 0), (1.25, 0.5, 0)])
        simplices = numpy.array([(0, 1), (1, 2), (2, 3), (3, 0)], "i4")
        topology = f'TopologyType="Polyline" NodesPerElement="2" NumberOfElements="{len(simplices)}"'
    file[f"{group}/vertices"] = vertices
    file[f"{group}/simplices"] = simplices
    return f"""
   <Grid Name="body" GridType="Uniform">
    <Topology {topology}>
     <DataItem Dimensions="{len(simplices)} {dim}" NumberType="Int" Format="HDF">frames.h5:{group}/simplices</DataItem>
    </Topology>
    <Geometry GeometryType="XYZ">
     <DataItem Dimensions="{len(vertices)} 3" NumberType="Float" Precision="8" Format="HDF">frames.h5:{group}/vertices</DataItem>
    </Geometry>
   </Grid>""" + write_elements(file, group, len(vertices), dim)


def write_drops(file, group, drops):
    points = numpy.array(drops)
    file[f"{group}/vertices"], file[f"{group}/radius"] = points[:, :3], points[:, 3]
    file[f"{group}/simplices"] = numpy.arange(len(points), dtype="i4")
    return f"""
   <Grid Name="drops" GridType="Uniform">
    <Topology TopologyType="Polyvertex" NodesPerElement="1" NumberOfElements="{len(points)}">
     <DataItem Dimensions="{len(points)} 1" NumberType="Int" Format="HDF">frames.h5:{group}/simplices</DataItem>
    </Topology>
    <Geometry GeometryType="XYZ">
     <DataItem Dimensions="{len(points)} 3" NumberType="Float" Precision="8" Format="HDF">frames.h5:{group}/vertices</DataItem>
    </Geometry>
    <Attribute Name="radius" AttributeType="Scalar" Center="Node">
     <DataItem Dimensions="{len(points)}" NumberType="Float" Precision="8" Format="HDF">frames.h5:{group}/radius</DataItem>
    </Attribute>
   </Grid>"""


def main(folder, dim, drops=()):
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    frames = ""
    with h5py.File(folder / "frames.h5", "w") as file:
        for number, time in enumerate((0.0, 0.5)):
            group = f"/frame-{number:06d}"
            frames += f'\n  <Grid Name="frame {number}" GridType="Collection" CollectionType="Spatial">'
            frames += f'\n   <Time Value="{time}"/>'
            frames += write_fluid(file, group + "/fluid", dim, time) + write_body(file, group + "/body", dim)
            if number == 1 and len(drops) > 0:  # x, y, z, radius
                frames += write_drops(file, group + "/drops", drops)
            frames += "\n  </Grid>"
    (folder / "frames.xmf").write_text(
        '<?xml version="1.0"?>\n<Xdmf Version="3.0">\n <Domain>\n'
        f' <Grid Name="run" GridType="Collection" CollectionType="Temporal">{frames}\n </Grid>\n </Domain>\n</Xdmf>\n')


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]))
