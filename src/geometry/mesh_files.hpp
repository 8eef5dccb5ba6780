#pragma once
#include <string>

#include "geometry/surface_mesh.hpp"

namespace lockstep {

/// Reads a surface from an .obj (tinyobjloader), .stl (ASCII or binary, corners merged) or .off
/// file. 2D: .obj or .off polylines ("l" records / two-vertex faces). Polygons are split into
/// triangles. Throws InputError naming file, line or record, and what is wrong. Every rank reads.
template <int dim>
SurfaceMesh<dim> read_surface(const std::string& file);

}  // namespace lockstep
