#pragma once
#include "interfaces/registries.hpp"

namespace lockstep {

/// All plug-ins that ship with Lockstep. A driver with its own adds them to what this returns.
template <int dim>
Registries<dim> shipped_plug_ins();

}  // namespace lockstep
