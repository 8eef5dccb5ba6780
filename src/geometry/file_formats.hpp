#pragma once
#include <string>

#include "geometry/mesh_names.hpp"
#include "geometry/surface_mesh.hpp"

namespace lockstep {

/// The readers behind `read_surface`; the file is known to be readable. They fill in
/// what `names` can know, and throw InputError.
template <int dim>
SurfaceMesh<dim> read_obj(const std::string& file, MeshNames& names);
template <int dim>
SurfaceMesh<dim> read_off(const std::string& file, MeshNames& names);
SurfaceMesh<3> read_stl(const std::string& file, MeshNames& names);

}  // namespace lockstep
