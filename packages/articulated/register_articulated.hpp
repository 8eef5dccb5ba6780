#pragma once
#include "articulated/joint_registry.hpp"
#include "interfaces/registries.hpp"

namespace lockstep {

/// Adds joints between rigid bodies, of these types.
template <int dim>
void register_articulated(Registries<dim>& registries, const JointTypes<dim>& types);

}  // namespace lockstep
