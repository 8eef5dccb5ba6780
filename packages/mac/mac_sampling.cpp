#include <cmath>
#include <limits>

#include "mac/mac_fluid.hpp"
#include "transport/sample_lattice.hpp"

namespace lockstep {
namespace {

/// Interpolates from those samples around x that `has_value`; zero if there are none.
template <int dim, typename HasValue>
double mean_of(const SampleLattice<dim>& lattice, SampleKind kind, const Point<dim>& x,
               const CellField& field, const HasValue& has_value) {
  double weight = 0, sum = 0;
  for (const StencilCorner<dim>& corner : lattice.corners(kind, x)) {
    const bool at_wall = corner.id == Stencil<dim>::wall_sample;
    if (corner.weight == 0 || (!at_wall && (corner.id < 0 || !has_value(corner.id))))
      continue;
    weight += corner.weight;
    sum += at_wall ? 0 : corner.weight * field[corner.id];
  }
  return weight > 0 ? sum / weight : 0;
}

/// Where a point is: its cell, and in cells from the lower corner.
template <int dim>
struct GridPlace {
  int cell = -1;
  Point<dim> x;
};

/// Sides belong to the cells beside them, upper ones too; round-off may put a point beyond.
template <int dim>
GridPlace<dim> place_of(const TiledGrid<dim>& grid, const Point<dim>& point) {
  Point<dim> inner = grid.wrap(point);
  const double h = grid.spacing();
  GridPlace<dim> place;
  place.x = (inner - grid.lower()) / h;
  for (int a = 0; a < dim; ++a) {
    const int n = grid.n_cells()[a];
    const double round_off =
        8 * std::numeric_limits<double>::epsilon() * (std::abs(grid.lower()[a]) / h + n);
    for (const int side : {0, n}) {
      if (grid.description().periodic[a] || std::abs(place.x[a] - side) > round_off)
        continue;
      place.x[a] = side;
      inner[a] = grid.lower()[a] + (side == 0 ? 0.5 : n - 0.5) * h;
    }
  }
  place.cell = grid.cell_containing(inner);
  return place;
}

}  // namespace

template <int dim>
std::vector<FluidSample<dim>> MacFluid<dim>::sample(const std::vector<Point<dim>>& points) const {
  const TiledGrid<dim>& grid = domain_.grid;
  const SampleLattice<dim> lattice(grid);
  const GridState<dim>& state = geometry_.state;
  const bool has_pressure = last_step_ > 0;
  constexpr int n_values = dim + 2;
  // Each rank answers for its own cells; the sum is everybody's answer.
  std::vector<double> values(points.size() * n_values, 0.);
  for (std::size_t p = 0; p < points.size(); ++p) {
    const auto [cell, x] = place_of<dim>(grid, points[p]);
    if (cell < 0 || !grid.owned(cell) || state.cells[cell] != CellState::fluid ||
        (state.surface && state.surface->inside(grid.wrap(points[p])) >= 0))
      continue;
    double* value = &values[p * n_values];
    *value++ = 1;
    if (has_pressure)
      *value = mean_of<dim>(lattice, cell_centers, x, scaled_pressure_,
                            [&](int id) { return state.cells[id] == CellState::fluid; }) /
               last_step_;
    ++value;
    for (int axis = 0; axis < dim; ++axis)
      *value++ = mean_of<dim>(lattice, axis, x, prediction_[axis],
                              [&](int id) { return is_wet(state.faces[axis][id]); });
  }
  sum_all(domain_.grid.comm(), values.data(), static_cast<int>(values.size()));
  std::vector<FluidSample<dim>> samples(points.size());
  for (std::size_t p = 0; p < points.size(); ++p) {
    const double* value = &values[p * n_values];
    samples[p].in_fluid = value[0] > 0;
    samples[p].pressure = value[1];
    for (int axis = 0; axis < dim; ++axis)
      samples[p].velocity[axis] = value[2 + axis];
  }
  return samples;
}

template <int dim>
std::vector<FlowSample> MacFluid<dim>::flow_across(int axis,
                                                   const std::vector<Point<dim>>& points) const {
  const TiledGrid<dim>& grid = domain_.grid;
  const SampleLattice<dim> lattice(grid);
  const auto& cells = geometry_.state.cells;
  const auto is_fluid = [&cells](int cell) { return cells[cell] == CellState::fluid; };
  const auto in_domain = [&](int face) {
    if (face < 0)
      return false;
    const FaceCells beside = cells_of_face(grid, cells, axis, face);
    return beside.lower >= 0 || beside.upper >= 0;
  };
  constexpr int n_values = 3;
  std::vector<double> values(points.size() * n_values, 0.);
  for (std::size_t p = 0; p < points.size(); ++p) {
    const auto [cell, x] = place_of<dim>(grid, points[p]);
    if (cell < 0 || !grid.owned(cell) || !is_fluid(cell))
      continue;
    double weight = 0, open = 0, rate = 0;
    for (const StencilCorner<dim>& corner : lattice.corners(axis, x)) {
      const bool at_wall = corner.id == Stencil<dim>::wall_sample;
      if (corner.weight == 0 || (!at_wall && !in_domain(corner.id)))
        continue;
      weight += corner.weight;
      const double part = at_wall ? 1 : geometry_.flux_fraction(axis, corner.id);
      open += corner.weight * part;
      rate += at_wall ? 0 : corner.weight * part * prediction_[axis][corner.id];
    }
    if (open == 0)
      continue;
    double* value = &values[p * n_values];
    value[0] = open / weight;
    value[1] = rate / weight;
    if (last_step_ > 0)
      value[2] = mean_of<dim>(lattice, cell_centers, x, scaled_pressure_, is_fluid) / last_step_;
  }
  sum_all(grid.comm(), values.data(), static_cast<int>(values.size()));
  std::vector<FlowSample> samples;
  for (std::size_t p = 0; p < points.size(); ++p)
    samples.push_back({values[3 * p], values[3 * p + 1], values[3 * p + 2]});
  return samples;
}

template <int dim>
std::vector<double> MacFluid<dim>::surface_distances(const std::vector<Point<dim>>& points) const {
  const TiledGrid<dim>& grid = domain_.grid;
  const SampleLattice<dim> lattice(grid);
  const CellField& phi = liquid_->interface().distance();
  constexpr double nothing_stored = 1e300;
  const std::size_t n = points.size();
  std::vector<double> values(2 * n, 0.0);  // distances; how many ranks know
  for (std::size_t p = 0; p < n; ++p) {
    const auto [cell, x] = place_of<dim>(grid, points[p]);
    if (cell < 0 || !grid.owned(cell))
      continue;
    const auto stencil = lattice.locate(cell_centers, x);
    values[p] = stencil.complete() ? interpolate<dim>(stencil, phi.data()) : phi[cell];
    values[n + p] = 1;
  }
  sum_all(grid.comm(), values.data(), static_cast<int>(values.size()));
  for (std::size_t p = 0; p < n; ++p)
    if (values[n + p] == 0)
      values[p] = nothing_stored;
  values.resize(n);
  return values;
}

template std::vector<FlowSample> MacFluid<2>::flow_across(int, const std::vector<Point<2>>&) const;
template std::vector<FlowSample> MacFluid<3>::flow_across(int, const std::vector<Point<3>>&) const;
template std::vector<double> MacFluid<2>::surface_distances(const std::vector<Point<2>>&) const;
template std::vector<double> MacFluid<3>::surface_distances(const std::vector<Point<3>>&) const;
template std::vector<FluidSample<2>> MacFluid<2>::sample(const std::vector<Point<2>>&) const;
template std::vector<FluidSample<3>> MacFluid<3>::sample(const std::vector<Point<3>>&) const;

}  // namespace lockstep
