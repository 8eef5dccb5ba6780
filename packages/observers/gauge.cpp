#include "observers/gauge.hpp"

#include <algorithm>
#include <cmath>

#include "base/errors.hpp"
#include "interfaces/liquid.hpp"
#include "observers/carried_points.hpp"

namespace lockstep {

namespace {
/// Largest number of samples of a gauge.
constexpr double most_samples = 1e6;

template <int dim>
const LiquidFluid<dim>& liquid_of(const FluidDiscretization<dim>& fluid) {
  const LiquidFluid<dim>* liquid = fluid.liquid();
  check_input(liquid != nullptr,
              "The observer \"gauge\" measures the height of a liquid, but the fluid fills the "
              "domain; leave it out, or give \"Fluid\" the list \"Free Surface\".");
  return *liquid;
}
}  // namespace

template <int dim>
ParameterList gauge_parameters() {
  ParameterList list;
  declare_required_vector<double>(list, "Points", 2 * dim,
                                  "The two ends, a component an axis [m]; lengths are measured "
                                  "from the first.");
  return list;
}

template <int dim>
Gauge<dim>::Gauge(const ParameterList& list) {
  const auto& ends = list.get<ParameterArray<double>>("Points");
  for (int a = 0; a < dim; ++a) {
    foot_[a] = ends[a];
    head_[a] = ends[dim + a];
  }
  check_input(foot_ != head_, "In \"{}\", the two \"Points\" of a gauge are one; it needs a line.",
              observer_path(list));
}

template <int dim>
std::vector<ObservedColumn> Gauge<dim>::columns() const {
  return {{"wet_length", "m", "of the line, in the liquid or in solids below its surface"},
          {"top", "m", "from its foot to the farthest place on it that is wet; 0 if none is"}};
}

template <int dim>
std::vector<std::vector<double>> Gauge<dim>::observe(const RunView<dim>& run) {
  const LiquidFluid<dim>& liquid = liquid_of<dim>(run.fluid);
  const double length = (head_ - foot_).norm();
  const double wanted = std::ceil(2 * length / run.fluid.smallest_length());
  check_input(wanted < most_samples,
              "A \"gauge\" of {:g} m is {:g} cells long, more than a gauge can be; bring its "
              "\"Points\" nearer to each other.",
              length, wanted / 2);
  const int n = std::max(1, static_cast<int>(wanted));
  std::vector<Point<dim>> points;
  for (int i = 0; i <= n; ++i)
    points.push_back(foot_ + (head_ - foot_) * i / n);
  const std::vector<double> distance = liquid.surface_distances(points);
  double wet = 0, top = 0;
  for (int i = 0; i < n; ++i) {
    const double begin = distance[i], end = distance[i + 1];
    if (begin >= 0 && end >= 0)
      continue;
    const double crossing = (begin < 0) != (end < 0) ? begin / (begin - end) : 1;
    wet += begin < 0 ? crossing : 1 - crossing;
    top = i + (end < 0 ? 1 : crossing);
  }
  return {{wet * length / n, top * length / n}};
}

template ParameterList gauge_parameters<2>();
template ParameterList gauge_parameters<3>();
template class Gauge<2>;
template class Gauge<3>;

}  // namespace lockstep
