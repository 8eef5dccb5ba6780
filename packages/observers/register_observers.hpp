#pragma once
#include "interfaces/registries.hpp"

namespace lockstep {

/// Registers the observers "points", "box", "nodes", "flow", "gauge" and "energy".
template <int dim>
void register_observers(ObserverRegistry<dim>& observers);

}  // namespace lockstep
