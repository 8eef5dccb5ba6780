#pragma once
#include <string>

#include "geometry/surface_mesh.hpp"

namespace lockstep {

/// The readers behind `read_surface`; the file is known to be readable. They throw InputError.
template <int dim>
SurfaceMesh<dim> read_obj(const std::string& file);
template <int dim>
SurfaceMesh<dim> read_off(const std::string& file);
SurfaceMesh<3> read_stl(const std::string& file);

}  // namespace lockstep
