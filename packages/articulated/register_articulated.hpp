#pragma once
#include "interfaces/registries.hpp"

namespace lockstep {

/// Adds the joints between rigid bodies.
template <int dim>
void register_articulated(Registries<dim>& registries);

}  // namespace lockstep
