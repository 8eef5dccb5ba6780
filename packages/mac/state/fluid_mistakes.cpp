#include "mac/state/fluid_mistakes.hpp"

#include <optional>

#include "liquid/liquid_mistakes.hpp"
#include "mac/forces/scalar_mistakes.hpp"
#include "mac/state/mac_parameters.hpp"
#include "staggered/domain/inflow_scalars.hpp"
#include "staggered/domain/parameter_values.hpp"

namespace lockstep {

template <int dim>
void find_fluid_mistakes(const ParameterList& fluid, const ParameterList& domain,
                         Mistakes& mistakes) {
  std::optional<DomainDescription<dim>> description;
  mistakes.collect([&] { description = read_domain<dim>(domain); });
  std::array<bool, dim> periodic{};
  const Point<dim> far = Point<dim>::Constant(1e300);
  Box<dim> bounds(-far, far);
  if (description) {
    mistakes.collect([&] { read_waves(fluid, domain, *description); });
    mistakes.collect([&] { read_inflow_scalars(fluid, domain, description->boundary); });
    periodic = description->grid.periodic;
    bounds = Box<dim>(point_value<dim>(domain, "Lower"), point_value<dim>(domain, "Upper"));
  }
  mistakes.collect([&] { read_mac_parameters<dim>(fluid); });
  find_scalar_mistakes<dim>(fluid, bounds, mistakes);
  if (fluid.isSublist("Free Surface"))
    find_liquid_mistakes<dim>(fluid, gravity_at_start<dim>(fluid), periodic, mistakes);
}

template void find_fluid_mistakes<2>(const ParameterList&, const ParameterList&, Mistakes&);
template void find_fluid_mistakes<3>(const ParameterList&, const ParameterList&, Mistakes&);

}  // namespace lockstep
