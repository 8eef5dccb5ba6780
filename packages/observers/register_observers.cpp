#include "observers/register_observers.hpp"

#include "observers/energy.hpp"
#include "observers/flow.hpp"
#include "observers/force.hpp"
#include "observers/gauge.hpp"
#include "observers/nodes.hpp"
#include "observers/probes.hpp"

namespace lockstep {

namespace {
/// A schema of points, with the solid that they may move with.
template <ParameterList (*points)()>
ParameterList carried() {
  ParameterList list = points();
  declare_carrier(list);
  return list;
}
}  // namespace

template <int dim>
void register_observers(ObserverRegistry<dim>& observers) {
  observers.add("points",
                "Pressure and velocity at points that you list, which may move with a solid.",
                carried<points_parameters<dim>>, [](const ParameterList& list) {
                  return std::make_unique<Probes<dim>>("points", listed_points<dim>(list), list);
                });
  observers.add("box",
                "Pressure and velocity at evenly spaced points of a line, a plane or a box, which "
                "may move with a solid.",
                carried<box_parameters<dim>>, [](const ParameterList& list) {
                  return std::make_unique<Probes<dim>>("box", box_points<dim>(list), list);
                });
  observers.add("nodes", "Place, displacement and velocity of points of a solid.",
                nodes_parameters<dim>,
                [](const ParameterList& list) { return std::make_unique<Nodes<dim>>(list); });
  observers.add("flow", "Volume that flows through a window, and its mean pressure.",
                flow_parameters<dim>,
                [](const ParameterList& list) { return std::make_unique<Flow<dim>>(list); });
  observers.add("force", "Force and torque of the fluid on a part of a solid's surface.",
                force_parameters<dim>,
                [](const ParameterList& list) { return std::make_unique<Force<dim>>(list); });
  observers.add("gauge", "Wet length of a line, as a wire gauge measures it.",
                gauge_parameters<dim>,
                [](const ParameterList& list) { return std::make_unique<Gauge<dim>>(list); });
  observers.add("energy", "Budget of the energy of a run, from its start on.",
                energy_parameters<dim>,
                [](const ParameterList&) { return std::make_unique<Energy<dim>>(); });
}

template void register_observers<2>(ObserverRegistry<2>&);
template void register_observers<3>(ObserverRegistry<3>&);

}  // namespace lockstep
