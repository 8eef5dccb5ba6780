#include "observers/flow.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "base/errors.hpp"
#include "base/round_off.hpp"
#include "interfaces/fluid_sides.hpp"
#include "interfaces/liquid.hpp"
#include "observers/probes.hpp"

namespace lockstep {

namespace {

/// 2000 by 2000; every rank asks for all of them.
constexpr double most_squares = 4e6;

template <int dim>
Window<dim> window_of(const Box<dim>& box, int axis) {
  Window<dim> window;
  window.corner = box.min();
  for (int k = 1; k < dim; ++k) {
    // In the order that turns to the positive axis.
    const int along = (axis + k) % dim;
    window.edges[k - 1] = box.sizes()[along] * Point<dim>::Unit(along);
  }
  if (dim == 2 && axis == 1) {  // a line along x has the positive axis on its left
    window.corner += window.edges[0];
    window.edges[0] *= -1;
  }
  return window;
}

template <int dim>
Box<dim> box_of(const Window<dim>& window) {
  Box<dim> box(window.corner, window.corner);
  Point<dim> far = window.corner;
  for (const Point<dim>& edge : window.edges) {
    box.extend(Point<dim>(window.corner + edge));
    far += edge;
  }
  box.extend(far);
  return box;
}

/// Points of a lattice over a window, `count` + 1 - 2 `inset` along each edge, the first `inset`
/// pieces away from the corner: of an inset 0.5 the middles of its `count` pieces.
template <int dim>
std::vector<Point<dim>> lattice_on(const Window<dim>& window, const std::array<int, dim - 1>& count,
                                   double inset) {
  std::vector<Point<dim>> points{window.corner};
  for (int k = 0; k < dim - 1; ++k) {
    const int n = count[k] + 1 - static_cast<int>(2 * inset);
    std::vector<Point<dim>> next;
    for (int i = 0; i < n; ++i)
      for (const Point<dim>& x : points)
        next.push_back(x + (i + inset) / count[k] * window.edges[k]);
    points = std::move(next);
  }
  return points;
}

/// The part of a piece in which the distance, multilinear between its corners, is negative. Bit k
/// of a corner's number: upper along edge k.
template <int n>
double wet_part(const Point<n>& size, const std::array<double, 1 << n>& corners) {
  const auto distance = [&](const Point<n>& x) {
    double sum = 0;
    for (int corner = 0; corner < 1 << n; ++corner) {
      double weight = 1;
      for (int k = 0; k < n; ++k)
        weight *= (corner >> k) & 1 ? x[k] / size[k] : 1 - x[k] / size[k];
      sum += weight * corners[corner];
    }
    return sum;
  };
  const Box<n> part = part_below<n>(distance, Box<n>(Point<n>::Zero(), size));
  return part.isEmpty() ? 0 : part.volume() / size.prod();
}

/// The part of each piece of a window that is below the surface of a liquid; 1 everywhere for
/// fluid that fills its domain, or that goes on above the surface as a gas. Collective.
template <int dim>
std::vector<double> wet_parts(const FluidDiscretization<dim>& fluid, const Window<dim>& window,
                              const std::array<int, dim - 1>& count) {
  std::size_t n = 1;
  Point<dim - 1> size;
  for (int k = 0; k < dim - 1; ++k) {
    n *= count[k];
    size[k] = window.edges[k].norm() / count[k];
  }
  std::vector<double> parts(n, 1.0);
  const LiquidFluid<dim>* liquid = fluid.liquid();
  if (!liquid || liquid->gas_density() > 0)
    return parts;
  const std::vector<double> distance = liquid->surface_distances(lattice_on<dim>(window, count, 0));
  for (std::size_t piece = 0; piece < n; ++piece) {
    std::array<double, 1 << (dim - 1)> corners;
    for (int corner = 0; corner < 1 << (dim - 1); ++corner) {
      std::size_t place = 0, rest = piece, stride = 1;
      for (int k = 0; k < dim - 1; ++k) {
        place += stride * (rest % count[k] + ((corner >> k) & 1));
        rest /= count[k];
        stride *= count[k] + 1;
      }
      corners[corner] = distance[place];
    }
    parts[piece] = wet_part<dim - 1>(size, corners);
  }
  return parts;
}

}  // namespace

template <int dim>
Point<dim> Window<dim>::area_vector() const {
  if constexpr (dim == 2)
    return {edges[0].y(), -edges[0].x()};
  else
    return edges[0].cross(edges[1]);
}

template <int dim>
ParameterList flow_parameters() {
  ParameterList list;
  declare_optional<ParameterArray<double>>(
      list, "Lower", "One corner of a window at right angles to an axis [m].");
  declare_optional<ParameterArray<double>>(
      list, "Upper", "The opposite corner; along one axis, that of the flow, as \"Lower\" [m].");
  for (const char* corner : {"Lower", "Upper"})
    set_length(list, corner, dim);
  declare_optional<ParameterArray<double>>(
      list, "Points",
      dim == 2 ? "In their place the two ends of a line in any direction [m]; what flows to the "
                 "right of the way from the first to the second counts as positive."
               : "In their place three corners of a parallelogram in any direction [m]: one, and "
                 "its two neighbours; what flows along the cross product of the ways to these "
                 "counts as positive.");
  set_length(list, "Points", dim * dim);
  return list;
}

template <int dim>
Flow<dim>::Flow(const ParameterList& list) : path_(observer_path(list)) {
  const bool by_points = list.isParameter("Points");
  const bool by_box = list.isParameter("Lower") && list.isParameter("Upper");
  check_input(
      by_points != by_box && by_points == !(list.isParameter("Lower") || list.isParameter("Upper")),
      "In \"{}\", the window of a flow is either between \"Lower\" and \"Upper\" or given by "
      "\"Points\"; give one of the two.",
      path_);
  if (by_box) {
    read_box(list);
    return;
  }
  const std::vector<Point<dim>> points = listed_points<dim>(list);
  window_.corner = points[0];
  double size = 1;
  for (int k = 0; k < dim - 1; ++k) {
    window_.edges[k] = points[k + 1] - points[0];
    size *= window_.edges[k].norm();
  }
  check_input(window_.area_vector().norm() > rounding::differences * size,
              "In \"{}\", the window of a flow has no extent: its \"Points\" are {}.", path_,
              dim == 2 ? "one" : "on a line");
}

template <int dim>
void Flow<dim>::read_box(const ParameterList& list) {
  const auto& lower = list.get<ParameterArray<double>>("Lower");
  const auto& upper = list.get<ParameterArray<double>>("Upper");
  Box<dim> box;
  int n_flat = 0;
  for (int a = 0; a < dim; ++a) {
    box.min()[a] = std::min(lower[a], upper[a]);
    box.max()[a] = std::max(lower[a], upper[a]);
    if (lower[a] != upper[a])
      continue;
    axis_ = a;
    ++n_flat;
  }
  check_input(n_flat == 1,
              "In \"{}\", the window of a flow has no extent along {} axes; it must have none "
              "along exactly one, that of the flow.",
              path_, n_flat);
  window_ = window_of(box, axis_);
}

template <int dim>
std::vector<ObservedColumn> Flow<dim>::columns() const {
  return {{"volume_rate", dim == 2 ? "m^2/s" : "m^3/s",
           axis_ >= 0 ? "along the positive axis"
           : dim == 2 ? "to the right of the way from the first point to the second"
                      : "along the cross product of the two edges"},
          {"open_area", dim == 2 ? "m" : "m^2", "part of the window that is in the fluid"},
          {"mean_pressure", "Pa", "over that part; 0 if there is none"}};
}

/// The rest of it lies where there never is a fluid.
template <int dim>
Window<dim> Flow<dim>::part_of_box(const Box<dim>& bounds) const {
  const Box<dim> whole = box_of(window_);
  const Box<dim> part = whole.intersection(bounds);
  for (int a = 0; a < dim; ++a)
    check_input(part.max()[a] > part.min()[a] || (a == axis_ && part.max()[a] == part.min()[a]),
                "In \"{}\", the window of a flow lies outside of the fluid: along {} it "
                "reaches from {} to {} m, the domain from {} to {} m.",
                path_, axis_names[a], whole.min()[a], whole.max()[a], bounds.min()[a],
                bounds.max()[a]);
  return window_of(part, axis_);
}

template <int dim>
void Flow<dim>::check_inside(const Box<dim>& bounds) const {
  const Box<dim> whole = box_of(window_);
  const double tiny = rounding::differences * bounds.sizes().maxCoeff();
  for (int a = 0; a < dim; ++a)
    check_input(
        whole.min()[a] >= bounds.min()[a] - tiny && whole.max()[a] <= bounds.max()[a] + tiny,
        "In \"{}\", the window of a flow sticks out of the fluid: along {} it reaches from {} to "
        "{} "
        "m, the domain from {} to {} m; move its \"Points\" inside.",
        path_, axis_names[a], whole.min()[a], whole.max()[a], bounds.min()[a], bounds.max()[a]);
}

/// Across periodic sides there is fluid, too.
template <int dim>
Window<dim> Flow<dim>::part_in(const FluidDiscretization<dim>& fluid) const {
  if (fluid.is_periodic())
    return window_;
  if (axis_ >= 0)
    return part_of_box(fluid.bounds());
  check_inside(fluid.bounds());
  return window_;
}

template <int dim>
std::vector<std::vector<double>> Flow<dim>::observe(const RunView<dim>& run) {
  const Window<dim> window = part_in(run.fluid);
  std::array<int, dim - 1> count{};
  double total = 1;
  for (int k = 0; k < dim - 1; ++k) {
    const double wanted = std::ceil(window.edges[k].norm() / run.fluid.smallest_length() - 1e-9);
    total *= std::max(wanted, 1.);
    count[k] = static_cast<int>(std::clamp(wanted, 1., most_squares));
  }
  check_input(total <= most_squares,
              "In \"{}\", the window of a flow has {:g} squares as large as cells, more than "
              "{:g}; make it smaller.",
              path_, total, most_squares);
  const std::vector<Point<dim>> points = lattice_on<dim>(window, count, 0.5);
  const std::vector<double> wet = wet_parts<dim>(run.fluid, window, count);
  const double area = window.area_vector().norm() / total;
  const Point<dim> normal = window.area_vector().normalized();
  const FluidOutput<dim>& fluid = output_of(run.fluid, this->name());
  double rate = 0, open = 0, pressure = 0;
  // The balance of volume is that of faces along the axes: u n = sum of u_a n_a, and what is open
  // is weighed by the squares n_a^2, whose sum is 1.
  for (int a = 0; a < dim; ++a) {
    if (std::abs(normal[a]) < rounding::differences)
      continue;
    const double share = area * normal[a] * normal[a];
    const std::vector<FlowSample> samples = fluid.flow_across(a, points);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      rate += wet[i] * area * normal[a] * samples[i].rate;
      open += wet[i] * share * samples[i].open;
      pressure += wet[i] * share * samples[i].open * samples[i].pressure;
    }
  }
  return {{rate, open, open > 0 ? pressure / open : 0}};
}

template struct Window<2>;
template struct Window<3>;
template ParameterList flow_parameters<2>();
template ParameterList flow_parameters<3>();
template class Flow<2>;
template class Flow<3>;

}  // namespace lockstep
