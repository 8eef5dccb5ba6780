#pragma once
#include "deformable/materials/material_registry.hpp"
#include "interfaces/registries.hpp"

namespace lockstep {

/// Registers the solid models "deformable body" and "cloth". One model holds all bodies of its type
/// in a scene; the schema in the registry is that of one body (see `deformable_body_parameters` and
/// `cloth_parameters`). `materials`: the laws that "deformable body" may name.
template <int dim>
void register_deformable(SolidRegistry<dim>& solids,
                         const std::shared_ptr<const MaterialRegistry<dim>>& materials);

}  // namespace lockstep
