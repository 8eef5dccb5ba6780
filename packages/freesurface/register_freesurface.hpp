#pragma once
#include "mac/liquid/interface_model.hpp"

namespace lockstep {

/// Registers the interface "level set".
template <int dim>
void register_freesurface(InterfaceRegistry<dim>& interfaces);

}  // namespace lockstep
