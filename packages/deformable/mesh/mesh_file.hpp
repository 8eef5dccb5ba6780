#pragma once
#include <string>

#include "deformable/mesh/volume_mesh.hpp"

namespace lockstep {

/// The triangles (2D) or tetrahedra (3D) of a .msh (Gmsh) or .vtk file, and what
/// the file calls them. Throws InputError. Every rank reads.
template <int dim>
VolumeMesh<dim> read_volume_mesh(const std::string& file, MeshNames& names);

/// The segments (2D) or triangles (3D) of such a file, or of one that `read_surface` knows, as an
/// open or closed surface.
template <int dim>
SurfaceMesh<dim> read_shell_mesh(const std::string& file, MeshNames& names);

}  // namespace lockstep
