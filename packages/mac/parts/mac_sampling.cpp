#include "mac/parts/grid_place.hpp"
#include "mac/parts/mac_output.hpp"

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

/// From a cell of air to a neighbour across `axis` that is liquid, zero if there is none [cells].
template <int dim>
Point<dim> way_to_liquid(const TiledGrid<dim>& grid, const std::vector<CellState>& cells, int axis,
                         int cell) {
  for (int a = 0; a < dim; ++a)
    for (int end = 0; end < 2 && a != axis; ++end) {
      const int neighbor = grid.neighbor(cell, a, end);
      if (neighbor >= 0 && cells[neighbor] == CellState::fluid)
        return Point<dim>::Unit(a) * (end == 0 ? -1 : 1);
    }
  return Point<dim>::Zero();
}

}  // namespace

template <int dim>
std::vector<FluidSample<dim>> MacOutput<dim>::sample(const std::vector<Point<dim>>& points) const {
  const TiledGrid<dim>& grid = flow_.domain.grid;
  const SampleLattice<dim> lattice(grid);
  const GridState<dim>& state = flow_.geometry.state;
  const bool has_pressure = flow_.last_step > 0;
  // Each rank answers for its own cells; the sum is everybody's answer.
  std::vector<FluidSample<dim>> samples(points.size());
  for (std::size_t p = 0; p < points.size(); ++p) {
    const auto [cell, x] = place_of<dim>(grid, points[p]);
    if (cell < 0 || !grid.owned(cell) || state.cells[cell] != CellState::fluid ||
        (state.surface && state.surface->inside(grid.wrap(points[p])) >= 0))
      continue;
    samples[p].in_fluid = true;
    if (has_pressure)
      samples[p].pressure =
          mean_of<dim>(lattice, cell_centers, x, flow_.scaled_pressure,
                       [&](int id) { return state.cells[id] == CellState::fluid; }) /
          flow_.last_step;
    for (int axis = 0; axis < dim; ++axis)
      samples[p].velocity[axis] =
          mean_of<dim>(lattice, axis, x, flow_.prediction[axis],
                       [&](int id) { return is_wet(state.faces[axis][id]); });
  }
  sum_over_ranks(flow_.domain.grid.comm(), samples);
  return samples;
}

template <int dim>
std::vector<FlowSample> MacOutput<dim>::flow_across(int axis,
                                                    const std::vector<Point<dim>>& points) const {
  const TiledGrid<dim>& grid = flow_.domain.grid;
  const SampleLattice<dim> lattice(grid);
  const auto& cells = flow_.geometry.state.cells;
  const auto is_fluid = [&cells](int cell) { return cells[cell] == CellState::fluid; };
  const auto is_air = [&cells](int cell) { return cell < 0 || cells[cell] == CellState::air; };
  // Faces within air that has no mass tell nothing of the liquid's velocity.
  const auto tells = [&](int face) {
    if (face < 0)
      return false;
    const FaceCells beside = cells_of_face(grid, cells, axis, face);
    return (beside.lower >= 0 || beside.upper >= 0) &&
           !(is_air(beside.lower) && is_air(beside.upper));
  };
  std::vector<FlowSample> samples(points.size());
  for (std::size_t p = 0; p < points.size(); ++p) {
    const auto [cell, place] = place_of<dim>(grid, points[p]);
    if (cell < 0 || !grid.owned(cell))
      continue;
    Point<dim> x = place;
    if (cells[cell] == CellState::air)
      x += way_to_liquid(grid, cells, axis, cell);
    else if (!is_fluid(cell))
      continue;
    double weight = 0, open = 0, rate = 0;
    for (const StencilCorner<dim>& corner : lattice.corners(axis, x)) {
      const bool at_wall = corner.id == Stencil<dim>::wall_sample;
      if (corner.weight == 0 || (!at_wall && !tells(corner.id)))
        continue;
      weight += corner.weight;
      const double part = at_wall ? 1 : flow_.geometry.flux_fraction(axis, corner.id);
      open += corner.weight * part;
      rate += at_wall ? 0 : corner.weight * part * flow_.prediction[axis][corner.id];
    }
    if (open == 0)
      continue;
    samples[p].open = open / weight;
    samples[p].rate = rate / weight;
    if (flow_.last_step > 0)
      samples[p].pressure =
          mean_of<dim>(lattice, cell_centers, x, flow_.scaled_pressure, is_fluid) / flow_.last_step;
  }
  sum_over_ranks(grid.comm(), samples);
  return samples;
}

template std::vector<FlowSample> MacOutput<2>::flow_across(int, const std::vector<Point<2>>&) const;
template std::vector<FlowSample> MacOutput<3>::flow_across(int, const std::vector<Point<3>>&) const;
template std::vector<FluidSample<2>> MacOutput<2>::sample(const std::vector<Point<2>>&) const;
template std::vector<FluidSample<3>> MacOutput<3>::sample(const std::vector<Point<3>>&) const;

}  // namespace lockstep
