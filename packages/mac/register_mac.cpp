#include "mac/register_mac.hpp"

#include "mac/mac_fluid.hpp"
#include "mac/state/fluid_mistakes.hpp"

namespace lockstep {

namespace {
/// Makes the fluid. Throws InputError with the mistakes of all its parts.
template <int dim>
std::unique_ptr<FluidDiscretization<dim>> make_fluid(const ParameterList& list,
                                                     const ParameterList& domain,
                                                     const Communicator& comm,
                                                     const InterfaceRegistry<dim>* interfaces) {
  std::unique_ptr<FluidDiscretization<dim>> fluid;
  Mistakes mistakes;
  mistakes.collect(
      [&] { fluid = std::make_unique<MacFluid<dim>>(list, domain, comm, interfaces); });
  if (!fluid)
    find_fluid_mistakes<dim>(list, domain, mistakes);
  mistakes.throw_all();
  return fluid;
}
}  // namespace

template <int dim>
void register_mac(
    Registry<FluidDiscretization<dim>, const ParameterList&, const Communicator&>& fluids,
    const std::shared_ptr<const InterfaceRegistry<dim>>& interfaces) {
  fluids.add(
      "mac", "Incompressible fluid on a staggered Cartesian grid of tiles.",
      [interfaces] { return mac_parameters<dim>(interfaces.get()); },
      [interfaces](const ParameterList& list, const ParameterList& domain,
                   const Communicator& comm) {
        return make_fluid<dim>(list, domain, comm, interfaces.get());
      });
}

template void register_mac<2>(
    Registry<FluidDiscretization<2>, const ParameterList&, const Communicator&>&,
    const std::shared_ptr<const InterfaceRegistry<2>>&);
template void register_mac<3>(
    Registry<FluidDiscretization<3>, const ParameterList&, const Communicator&>&,
    const std::shared_ptr<const InterfaceRegistry<3>>&);

}  // namespace lockstep
