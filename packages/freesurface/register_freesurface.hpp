#pragma once
#include "mac/liquid/interface_model.hpp"

namespace lockstep {

/// Registers the interfaces "particle level set" and "level set".
template <int dim>
void register_freesurface(InterfaceRegistry<dim>& interfaces);

}  // namespace lockstep
