#include "observers/flow.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/errors.hpp"
#include "interfaces/fluid_sides.hpp"
#include "observers/probes.hpp"

namespace lockstep {

namespace {
/// 2000 by 2000; every rank asks for all of them.
constexpr double most_squares = 4e6;
}  // namespace

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

/// The rest of it lies where there never is a fluid; across periodic sides there is one.
template <int dim>
Box<dim> Flow<dim>::part_in(const FluidDiscretization<dim>& fluid) const {
  if (fluid.is_periodic())
    return window_;
  const Box<dim> part = window_.intersection(fluid.bounds());
  for (int a = 0; a < dim; ++a)
    check_input(part.max()[a] > part.min()[a] || (a == axis_ && part.max()[a] == part.min()[a]),
                "In \"Observers\", the window of a flow lies outside of the fluid: along {} it "
                "reaches from {} to {} m, the domain from {} to {} m.",
                axis_names[a], window_.min()[a], window_.max()[a], fluid.bounds().min()[a],
                fluid.bounds().max()[a]);
  return part;
}

template <int dim>
std::vector<std::vector<double>> Flow<dim>::observe(const RunView<dim>& run) {
  const Box<dim> window = part_in(run.fluid);
  std::array<double, dim> wanted;
  double total = 1;
  for (int a = 0; a < dim; ++a) {
    wanted[a] = a == axis_ ? 1 : std::ceil(window.sizes()[a] / run.fluid.smallest_length() - 1e-9);
    total *= std::max(wanted[a], 1.);
  }
  check_input(
      total <= most_squares,
      "In \"Observers\", the window of a flow has {:g} squares as large as cells, more than "
      "{:g}; make it smaller.",
      total, most_squares);
  Index<dim> count;
  Box<dim> middles = window;
  double area = 1;
  for (int a = 0; a < dim; ++a) {
    count[a] = std::max(static_cast<int>(wanted[a]), 1);
    if (a == axis_)
      continue;
    const double edge = window.sizes()[a] / count[a];
    area *= edge;
    middles.min()[a] += edge / 2;
    middles.max()[a] -= edge / 2;
  }
  double rate = 0, open = 0, pressure = 0;
  for (const FlowSample& sample :
       output_of(run.fluid, this->name()).flow_across(axis_, lattice_points<dim>(middles, count))) {
    rate += area * sample.rate;
    open += area * sample.open;
    pressure += area * sample.open * sample.pressure;
  }
  return {{rate, open, open > 0 ? pressure / open : 0}};
}

template ParameterList flow_parameters<2>();
template ParameterList flow_parameters<3>();
template class Flow<2>;
template class Flow<3>;

}  // namespace lockstep
