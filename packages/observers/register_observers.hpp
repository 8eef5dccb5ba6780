#pragma once
#include "interfaces/registries.hpp"

namespace lockstep {

/// Registers the observers "points", "box", "flow" and "gauge".
template <int dim>
void register_observers(ObserverRegistry<dim>& observers);

}  // namespace lockstep
