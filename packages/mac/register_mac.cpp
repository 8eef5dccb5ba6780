#include "mac/register_mac.hpp"

#include "mac/mac_fluid.hpp"

namespace lockstep {

template <int dim>
void register_mac(
    Registry<FluidDiscretization<dim>, const ParameterList&, const Communicator&>& fluids,
    const std::shared_ptr<const InterfaceRegistry<dim>>& interfaces) {
  fluids.add(
      "mac", "Incompressible fluid on a staggered Cartesian grid of tiles.",
      [interfaces] { return mac_parameters<dim>(interfaces.get()); },
      [interfaces](const ParameterList& list, const ParameterList& domain,
                   const Communicator& comm) {
        return std::make_unique<MacFluid<dim>>(list, domain, comm, interfaces.get());
      });
}

template void register_mac<2>(
    Registry<FluidDiscretization<2>, const ParameterList&, const Communicator&>&,
    const std::shared_ptr<const InterfaceRegistry<2>>&);
template void register_mac<3>(
    Registry<FluidDiscretization<3>, const ParameterList&, const Communicator&>&,
    const std::shared_ptr<const InterfaceRegistry<3>>&);

}  // namespace lockstep
