#include "observers/flow.hpp"

#include <cmath>

#include "base/errors.hpp"
#include "observers/probes.hpp"

namespace lockstep {

template <int dim>
ParameterList flow_parameters() {
  ParameterList list;
  declare_required_vector<double>(list, "Lower", dim, "One corner of the window [m].");
  declare_required_vector<double>(
      list, "Upper", dim,
      "The opposite corner; along one axis, that of the flow, as \"Lower\" [m].");
  return list;
}

template <int dim>
Flow<dim>::Flow(const ParameterList& list) {
  const auto& lower = list.get<ParameterArray<double>>("Lower");
  const auto& upper = list.get<ParameterArray<double>>("Upper");
  int n_flat = 0;
  for (int a = 0; a < dim; ++a) {
    window_.min()[a] = std::min(lower[a], upper[a]);
    window_.max()[a] = std::max(lower[a], upper[a]);
    if (lower[a] != upper[a])
      continue;
    axis_ = a;
    ++n_flat;
  }
  check_input(
      n_flat == 1,
      "In \"Observers\", the window of a flow has no extent along {} axes; it must have none "
      "along exactly one, that of the flow.",
      n_flat);
}

template <int dim>
std::vector<ObservedColumn> Flow<dim>::columns() const {
  return {{"volume_rate", dim == 2 ? "m^2/s" : "m^3/s", "along the positive axis"},
          {"open_area", dim == 2 ? "m" : "m^2", "part of the window that is in the fluid"},
          {"mean_pressure", "Pa", "over that part; 0 if there is none"}};
}

template <int dim>
std::vector<std::vector<double>> Flow<dim>::observe(const RunView<dim>& run) {
  Index<dim> count;
  Box<dim> middles = window_;
  double area = 1;
  for (int a = 0; a < dim; ++a) {
    const double extent = window_.sizes()[a];
    count[a] =
        a == axis_ ? 1 : static_cast<int>(std::ceil(extent / run.fluid.smallest_length() - 1e-9));
    if (a == axis_)
      continue;
    area *= extent / count[a];
    middles.min()[a] += extent / (2 * count[a]);
    middles.max()[a] -= extent / (2 * count[a]);
  }
  double rate = 0, open = 0, pressure = 0;
  for (const auto& sample :
       sample_fluid(run.fluid, lattice_points<dim>(middles, count), this->name())) {
    if (!sample.in_fluid)
      continue;
    rate += area * sample.velocity[axis_];
    open += area;
    pressure += area * sample.pressure;
  }
  return {{rate, open, open > 0 ? pressure / open : 0}};
}

template ParameterList flow_parameters<2>();
template ParameterList flow_parameters<3>();
template class Flow<2>;
template class Flow<3>;

}  // namespace lockstep
