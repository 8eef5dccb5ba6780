#include "liquid/liquid_mistakes.hpp"

#include "liquid/liquid_parameters.hpp"
#include "liquid/watch/watch.hpp"

namespace lockstep {

template <int dim>
void find_liquid_mistakes(const ParameterList& fluid, const Point<dim>& gravity,
                          const std::array<bool, dim>& periodic, Mistakes& mistakes) {
  const ParameterList& list = fluid.sublist("Free Surface");
  mistakes.collect([&] { check_free_surface<dim>(fluid, gravity, periodic); });
  mistakes.collect([&] { read_liquid<dim>(fluid, gravity); });
  mistakes.collect([&] { read_sinks<dim>(list); });
  mistakes.collect([&] { read_dry_points<dim>(list); });
  mistakes.collect([&] { read_watches<dim>(list); });
  mistakes.collect([&] { read_gas<dim>(fluid); });
}

template void find_liquid_mistakes<2>(const ParameterList&, const Point<2>&,
                                      const std::array<bool, 2>&, Mistakes&);
template void find_liquid_mistakes<3>(const ParameterList&, const Point<3>&,
                                      const std::array<bool, 3>&, Mistakes&);

}  // namespace lockstep
