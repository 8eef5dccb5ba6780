#pragma once
#include <array>
#include <string>
#include <vector>

#include "deformable/mesh/volume_mesh.hpp"

namespace lockstep {

/// The triangles (2D) or tetrahedra (3D) of a Gmsh file, ASCII of version 2.2 or 4.1; simplices of
/// other dimensions in it are skipped, vertices that none uses are dropped. Throws InputError
/// naming file and line for anything else, elements of higher order included. Every rank reads.
template <int dim>
VolumeMesh<dim> read_gmsh_volume(const std::string& file);

/// The segments (2D) or triangles (3D) of such a file, as an open or closed surface.
template <int dim>
SurfaceMesh<dim> read_gmsh_surface(const std::string& file);

}  // namespace lockstep
