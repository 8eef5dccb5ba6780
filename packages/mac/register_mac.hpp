#pragma once
#include <memory>

#include "liquid/common/interface_model.hpp"

namespace lockstep {

/// Registers the fluid "mac". Arguments of the factory beside the "Fluid" list: the validated
/// "Domain" list (see `domain_parameters`) and the communicator. Without interface models it knows
/// no free surface.
template <int dim>
void register_mac(
    Registry<FluidDiscretization<dim>, const ParameterList&, const Communicator&>& fluids,
    const std::shared_ptr<const InterfaceRegistry<dim>>& interfaces = nullptr);

}  // namespace lockstep
