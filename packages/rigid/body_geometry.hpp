#pragma once
#include <string>

#include "geometry/surface_mesh.hpp"
#include "parameters/parameter_list.hpp"

namespace lockstep {

/// A body's surface in its own coordinates.
template <int dim>
struct BodyGeometry {
  SurfaceMesh<dim> surface;
  bool closed = true;  ///< encloses a volume; false: a thin shell
};

/// Declares the sublist "Geometry".
template <int dim>
void declare_geometry(ParameterList& body);

/// Generates or reads the surface that a validated "Geometry" list describes. A "File" must be
/// absolute or relative to the working directory. `grid_spacing` [m] sets the default resolution,
/// `name` is used in messages. Throws InputError for sizes that are missing or belong to another
/// shape, and for unfit meshes. Every rank reads.
template <int dim>
BodyGeometry<dim> make_body_geometry(const ParameterList& geometry, double grid_spacing,
                                     const std::string& name);

}  // namespace lockstep
