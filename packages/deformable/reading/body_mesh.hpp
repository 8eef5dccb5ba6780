#pragma once
#include <string>

#include "deformable/mesh/volume_mesh.hpp"
#include "parameters/parameter_list.hpp"

namespace lockstep {

/// Declares the sublist "Geometry" of a deformable volume.
template <int dim>
void declare_deformable_geometry(ParameterList& body);

/// Generates or reads the mesh that a validated "Geometry" list describes, checked. `name` is used
/// in messages; `names`: what the file calls what it holds. Throws InputError for sizes that are
/// missing or belong to another shape, and for unfit meshes. Every rank reads.
template <int dim>
VolumeMesh<dim> make_body_mesh(const ParameterList& geometry, double grid_spacing,
                               const std::string& name, MeshNames& names);

}  // namespace lockstep
