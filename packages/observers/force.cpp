#include "observers/force.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/errors.hpp"
#include "geometry/surface_mesh.hpp"
#include "observers/carried_points.hpp"
#include "output/checkpoint.hpp"
#include "parameters/formula.hpp"

namespace lockstep {

namespace {

constexpr const char* stored_corners = "corners at start";

/// Pieces along an edge of a simplex that measure how much of it is of a part, at most.
constexpr double most_pieces = 200;

/// Calls `visit(centroid)` for the pieces of a simplex, all of one size.
template <typename Visit>
void for_each_piece(const std::array<Point<2>, 2>& corners, int n, const Visit& visit) {
  for (int i = 0; i < n; ++i)
    visit(Point<2>(corners[0] + (i + 0.5) / n * (corners[1] - corners[0])));
}
template <typename Visit>
void for_each_piece(const std::array<Point<3>, 3>& corners, int n, const Visit& visit) {
  const Point<3> u = (corners[1] - corners[0]) / n, v = (corners[2] - corners[0]) / n;
  for (int i = 0; i < n; ++i)
    for (int j = 0; i + j < n; ++j) {
      visit(Point<3>(corners[0] + (i + 1. / 3) * u + (j + 1. / 3) * v));
      if (i + j + 1 < n)
        visit(Point<3>(corners[0] + (i + 2. / 3) * u + (j + 2. / 3) * v));
    }
}

template <int dim>
double longest_edge(const std::array<Point<dim>, dim>& corners) {
  double longest = 0;
  for (int k = 0; k < dim; ++k)
    longest = std::max(longest, (corners[(k + 1) % dim] - corners[k]).norm());
  return longest;
}

}  // namespace

template <int dim>
ParameterList force_parameters() {
  ParameterList list;
  declare_required<std::string>(list, "Solid", "The solid that the part is of.");
  declare_optional<ParameterArray<double>>(
      list, "Lower",
      "The part is in a box from this corner on, where its points are at the start [m].");
  declare_optional<ParameterArray<double>>(
      list, "Upper", "The opposite corner of this box, whose sides there are not in it [m].");
  for (const char* corner : {"Lower", "Upper"})
    set_length(list, corner, dim);
  declare_optional<double>(
      list, "Expression",
      dim == 2 ? "The part is where this formula of x and y [m] at the start is above zero."
               : "The part is where this formula of x, y and z [m] at the start is above zero.");
  set_variables(list, "Expression", place_and_time(dim));
  return list;
}

template <int dim>
Force<dim>::Force(const ParameterList& list)
    : path_(observer_path(list)), solid_(list.get<std::string>("Solid")) {
  constexpr double far = std::numeric_limits<double>::infinity();
  box_ = Box<dim>(Point<dim>::Constant(-far), Point<dim>::Constant(far));
  const auto take = [&](const char* name, Point<dim>& corner) {
    if (list.isParameter(name))
      std::copy_n(list.get<ParameterArray<double>>(name).begin(), dim, corner.data());
  };
  take("Lower", box_.min());
  take("Upper", box_.max());
  for (int a = 0; a < dim; ++a)
    check_input(box_.min()[a] < box_.max()[a],
                "In \"{}\", the box of the part has nothing in it: along {} it reaches from {} to "
                "{} m.",
                path_, axis_names[a], box_.min()[a], box_.max()[a]);
  if (list.isParameter("Expression"))
    where_.emplace(list, "Expression", path_);
}

template <int dim>
std::vector<ObservedColumn> Force<dim>::columns() const {
  std::vector<ObservedColumn> columns = {
      {"area", dim == 2 ? "m" : "m^2", "area of the part at the start"}};
  for (int a = 0; a < dim; ++a)
    columns.push_back({std::string("f") + axis_names[a], "N",
                       "force of the fluid on the part, mean over the step"});
  for (int k = 0; k < n_rotations<dim>; ++k)
    columns.push_back({std::string("t") + axis_names[dim == 2 ? 2 : k], "N m",
                       "its torque about the centre of mass of the solid"});
  return columns;
}

template <int dim>
bool Force<dim>::includes(const Point<dim>& x) const {
  for (int a = 0; a < dim; ++a)
    if (x[a] < box_.min()[a] || x[a] >= box_.max()[a])
      return false;
  return !where_ || (*where_)(0, x, 0) > 0;
}

template <int dim>
void Force<dim>::begin(const ObservedSolid<dim>& observed, double spacing) {
  const SurfaceMesh<dim>& surface = observed.model->surface();
  for (int s = observed.solid->simplex_begin; s < observed.solid->simplex_end; ++s) {
    std::array<Point<dim>, dim> corners;
    for (int k = 0; k < dim; ++k)
      corners[k] = surface.vertices[surface.simplices[s][k]];
    at_start_.push_back(corners);
  }
  measure(spacing);
}

template <int dim>
void Force<dim>::measure(double spacing) {
  area_ = whole_area_ = 0;
  for (const auto& corners : at_start_) {
    const double pieces = std::ceil(longest_edge<dim>(corners) / (0.5 * spacing));
    const int n = static_cast<int>(std::min(std::max(pieces, 1.), most_pieces));
    int n_pieces = 0, n_in_part = 0;
    for_each_piece(corners, n, [&](const Point<dim>& x) {
      ++n_pieces;
      n_in_part += includes(x) ? 1 : 0;
    });
    const double area = area_vector<dim>(corners).norm();
    whole_area_ += area;
    area_ += area * n_in_part / n_pieces;
  }
  check_input(area_ > 0,
              "In \"{}\", no part of the surface of \"{}\" is where the part should be; places are "
              "those at the start of the run.",
              path_, solid_);
}

template <int dim>
Momentum<dim> Force<dim>::impulse_on_part(const ObservedSolid<dim>& observed,
                                          const SurfaceForces<dim>& forces) const {
  Momentum<dim> sum;
  for (const SurfaceImpulse<dim>& one : forces.at_places) {
    const int simplex = one.point.simplex - observed.simplex_begin;
    if (simplex < 0 || simplex >= static_cast<int>(at_start_.size()))
      continue;
    Point<dim> x = Point<dim>::Zero();
    for (int k = 0; k < dim; ++k)
      x += one.point.barycentric[k] * at_start_[simplex][k];
    if (includes(x))
      sum.add(one.place, one.impulse);
  }
  sum = sum_over_ranks<dim>(sum, observed.model->dof_map()->getComm());
  const Momentum<dim>& whole = forces.of_whole[observed.index];
  const double share = area_ / whole_area_;
  sum += {share * whole.linear, share * whole.angular};
  return sum;
}

template <int dim>
std::vector<std::vector<double>> Force<dim>::observe(const RunView<dim>& run) {
  const ObservedSolid<dim> observed = observed_solid(run, solid_, path_);
  check_input(observed.solid->simplex_end > observed.solid->simplex_begin,
              "\"{}\" asks for the force on a part of \"{}\", which has no surface; name a body "
              "or a shell.",
              path_, solid_);
  if (at_start_.empty())
    begin(observed, run.fluid.smallest_length());
  else if (whole_area_ == 0)
    measure(run.fluid.smallest_length());
  if (!run.forces)
    return {};
  const Momentum<dim> impulse = impulse_on_part(observed, *run.forces);
  const Point<dim>& center = run.solids[observed.index].center_of_mass;
  const Point<dim> force = impulse.linear / run.dt;
  const AngularVector<dim> torque = (impulse.angular - cross<dim>(center, impulse.linear)) / run.dt;
  std::vector<double> row{area_};
  row.insert(row.end(), force.data(), force.data() + dim);
  row.insert(row.end(), torque.data(), torque.data() + torque.size());
  return {row};
}

template <int dim>
void Force<dim>::save(CheckpointWriter& writer) const {
  std::vector<double> values;
  for (const auto& corners : at_start_)
    for (const Point<dim>& corner : corners)
      values.insert(values.end(), corner.data(), corner.data() + dim);
  writer.file().write_replicated(stored_corners, values, dim * dim);
}

template <int dim>
void Force<dim>::load(const CheckpointReader& reader) {
  const auto values = reader.file().template read_all<double>(stored_corners);
  constexpr int n = dim * dim;
  reader.check(values.size() % n == 0, "it has another part of \"" + path_ + "\"");
  at_start_.assign(values.size() / n, {});
  whole_area_ = 0;
  for (std::size_t s = 0; s < at_start_.size(); ++s)
    for (int k = 0; k < dim; ++k)
      at_start_[s][k] = Eigen::Map<const Point<dim>>(values.data() + n * s + dim * k);
}

template ParameterList force_parameters<2>();
template ParameterList force_parameters<3>();
template class Force<2>;
template class Force<3>;

}  // namespace lockstep
