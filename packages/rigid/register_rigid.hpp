#pragma once
#include "interfaces/registries.hpp"

namespace lockstep {

/// Registers the solid model "rigid body". One model holds all bodies of a scene; the schema in the
/// registry is that of one body (see `rigid_body_parameters`).
template <int dim>
void register_rigid(SolidRegistry<dim>& solids);

}  // namespace lockstep
