#pragma once
#include "interfaces/registries.hpp"

namespace lockstep {

/// Registers the solid models "deformable body" and "cloth". One model holds all bodies of its type
/// in a scene; the schema in the registry is that of one body (see `deformable_body_parameters` and
/// `cloth_parameters`).
template <int dim>
void register_deformable(SolidRegistry<dim>& solids);

}  // namespace lockstep
