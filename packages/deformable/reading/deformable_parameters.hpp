#pragma once
#include <string>

#include "deformable/deformable_body.hpp"
#include "deformable/materials/material_registry.hpp"
#include "parameters/parameter_list.hpp"

namespace lockstep {

/// Schema of a solid of type "deformable body", without "Type". `materials`: those that there are.
template <int dim>
ParameterList deformable_body_parameters(
    const MaterialRegistry<dim>& materials = shipped_materials<dim>());

/// Reads a body at the start from its list, validated against `deformable_body_parameters`. A
/// "File" must be absolute or relative to the working directory; `grid_spacing` [m] sets the
/// resolution of generated meshes; `gravity` [m/s^2] what its weight may crush. Throws InputError.
/// Every rank reads.
template <int dim>
DeformableBody<dim> read_deformable_body(
    const std::string& name, const ParameterList& list, double grid_spacing, double gravity = 0,
    const MaterialRegistry<dim>& materials = shipped_materials<dim>());

/// Schema of a solid of type "cloth", without "Type".
template <int dim>
ParameterList cloth_parameters();

/// Reads a thin shell at the start from its list, validated against `cloth_parameters`; the rest as
/// above.
template <int dim>
DeformableBody<dim> read_cloth(const std::string& name, const ParameterList& list,
                               double grid_spacing);

}  // namespace lockstep
