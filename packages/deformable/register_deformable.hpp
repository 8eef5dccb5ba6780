#pragma once
#include "stepping/registries.hpp"

namespace lockstep {

/// Registers the solid model "deformable body". One model holds all bodies of a scene; the schema
/// in the registry is that of one body (see `deformable_body_parameters`).
template <int dim>
void register_deformable(SolidRegistry<dim>& solids);

}  // namespace lockstep
