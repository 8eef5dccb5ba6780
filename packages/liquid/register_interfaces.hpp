#pragma once
#include "liquid/common/interface_model.hpp"

namespace lockstep {

/// Registers the interfaces "particle level set", "level set" and "volume of fluid".
template <int dim>
void register_interfaces(InterfaceRegistry<dim>& interfaces);

}  // namespace lockstep
