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

/// Wet part of a piece of a line, and how far on it the wet reaches; of its length.
struct WetPart {
  double share = 0, end = 0;
};

/// The distance is linear along the piece. Where a solid is on it, samples tell.
template <int dim>
WetPart wet_part(const LiquidFluid<dim>& liquid, const std::array<Point<dim>, 2>& ends,
                 const std::array<double, 2>& distance) {
  const bool begins = distance[0] < 0, ends_wet = distance[1] < 0;
  if (!begins && !ends_wet)
    return {};
  const double crossing = begins != ends_wet ? distance[0] / (distance[0] - distance[1]) : 1;
  WetPart part{begins ? crossing : 1 - crossing, ends_wet ? 1 : crossing};
  const auto at = [&](double place) { return Point<dim>((1 - place) * ends[0] + place * ends[1]); };
  if (!liquid.in_solid(at(0)) && !liquid.in_solid(at(0.5)) && !liquid.in_solid(at(1)))
    return part;
  constexpr int n_samples = 64;
  part = {};
  for (int i = 0; i < n_samples; ++i) {
    const double place = (i + 0.5) / n_samples;
    if ((1 - place) * distance[0] + place * distance[1] >= 0 || liquid.in_solid(at(place)))
      continue;
    part.share += 1. / n_samples;
    part.end = (i + 1.) / n_samples;
  }
  return part;
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
  return {{"wet_length", "m", "of the line, in the liquid; solids count as dry"},
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
  WetPart all;
  for (int i = 0; i < n; ++i) {
    const WetPart one =
        wet_part(liquid, {points[i], points[i + 1]}, {distance[i], distance[i + 1]});
    all.share += one.share / n;
    if (one.share > 0)
      all.end = (i + one.end) / n;
  }
  return {{all.share * length, all.end * length}};
}

template ParameterList gauge_parameters<2>();
template ParameterList gauge_parameters<3>();
template class Gauge<2>;
template class Gauge<3>;

}  // namespace lockstep
