#pragma once
#include <string>

#include "geometry/mesh_names.hpp"
#include "geometry/surface_mesh.hpp"

namespace lockstep {

/// Reads a surface from an .obj (tinyobjloader), .stl (ASCII or binary, corners merged) or .off
/// file. 2D: .obj or .off polylines ("l" records / two-vertex faces). Polygons are split into
/// triangles. Throws InputError naming file, line or record, and what is wrong. `names`: what the
/// file calls what it holds. Every rank reads.
template <int dim>
SurfaceMesh<dim> read_surface(const std::string& file, MeshNames& names);
template <int dim>
SurfaceMesh<dim> read_surface(const std::string& file);

/// Returns the extension of a file with its point, in lower case.
std::string lower_extension(const std::string& file);
/// Tells whether a file holds curved shapes, which Gmsh makes meshes of: .geo, .step, .iges, .brep.
bool is_shape_file(const std::string& file);

}  // namespace lockstep
