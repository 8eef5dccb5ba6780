#pragma once
#include "interfaces/fluid.hpp"
#include "parameters/registry.hpp"

namespace lockstep {

/// Registers the fluid "mac". Arguments of the factory beside the "Fluid" list: the validated
/// "Domain" list (see `domain_parameters`) and the communicator.
template <int dim>
void register_mac(
    Registry<FluidDiscretization<dim>, const ParameterList&, const Communicator&>& fluids);

}  // namespace lockstep
