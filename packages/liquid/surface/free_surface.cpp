#include "liquid/surface/free_surface.hpp"

#include <algorithm>

namespace lockstep {

namespace {
/// Least distance of a pressure from a gas bubble [cells]: the answer of the gas is a difference of
/// flows through its faces, which must not be lost in their round-off.
constexpr double least_distance_from_gas = 1e-3;
}  // namespace

template <int dim>
void empty_dry_cells(const TiledGrid<dim>& grid, const FreeSurface<dim>& free_surface,
                     std::vector<CellState>& cells) {
  grid.for_each_stored_cell([&](int cell) {
    if (cells[cell] == CellState::fluid && !free_surface.wet(cell))
      cells[cell] = CellState::air;
  });
}

template <int dim>
void set_phase_densities(const MacDomain<dim>& domain, const FreeSurface<dim>& free_surface,
                         MacGeometry<dim>& geometry) {
  const TiledGrid<dim>& grid = domain.grid;
  const double liquid = geometry.face_table.regular().density, gas = free_surface.gas_density;
  const auto part_of_liquid = [&](const FaceCells& face) {
    if (face.lower < 0 || face.upper < 0)
      return free_surface.wet(std::max(face.lower, face.upper)) ? 1.0 : 0.0;
    const bool lower = free_surface.wet(face.lower), upper = free_surface.wet(face.upper);
    if (lower == upper)
      return lower ? 1.0 : 0.0;
    return lower ? free_surface.crossing(face.lower, face.upper)
                 : free_surface.crossing(face.upper, face.lower);
  };
  // One entry more: it is empty on all ranks or on none, also on one without cells.
  geometry.lightness.assign(grid.n_stored_cells() + 1, 1);
  grid.for_each_stored_cell([&](int cell) {
    if (!free_surface.wet(cell))
      geometry.lightness[cell] = static_cast<float>(liquid / gas);
  });
  for (int axis = 0; axis < dim; ++axis)
    for (int cell = 0; cell < grid.n_stored_cells(); ++cell) {
      const FaceCells face = cells_of_face(grid, geometry.state.cells, axis, cell);
      if (face.lower < 0 && face.upper < 0)
        continue;
      if (const double part = part_of_liquid(face); part < 1)
        geometry.face_table.set_density(axis, cell, part * liquid + (1 - part) * gas);
    }
}

template <int dim>
void set_distance_factor_to_air(const MacDomain<dim>& domain, const FreeSurface<dim>& free_surface,
                                MacGeometry<dim>& geometry) {
  const TiledGrid<dim>& grid = domain.grid;
  const auto& cells = geometry.state.cells;
  const auto set = [&](int axis, int face, int wet, int dry) {
    if (cells[wet] == CellState::fluid && cells[dry] == CellState::air &&
        geometry.state.faces[axis][face] == FaceState::free)
      geometry.face_table.set_distance_factor(
          axis, face,
          free_surface.distance_factor(wet, dry,
                                       geometry.in_bubble(dry) ? least_distance_from_gas : 0));
  };
  grid.for_each_owned_cell_with_neighbors([&](int cell, const auto& neighbors) {
    for (int axis = 0; axis < dim; ++axis) {
      if (const int lower = neighbors[2 * axis]; lower >= 0) {
        set(axis, cell, lower, cell);
        set(axis, cell, cell, lower);
      }
      if (const int upper = neighbors[2 * axis + 1]; upper >= 0 && !grid.owned(upper)) {
        set(axis, upper, upper, cell);
        set(axis, upper, cell, upper);
      }
    }
  });
}

template void empty_dry_cells<2>(const TiledGrid<2>&, const FreeSurface<2>&,
                                 std::vector<CellState>&);
template void empty_dry_cells<3>(const TiledGrid<3>&, const FreeSurface<3>&,
                                 std::vector<CellState>&);
template void set_phase_densities<2>(const MacDomain<2>&, const FreeSurface<2>&, MacGeometry<2>&);
template void set_phase_densities<3>(const MacDomain<3>&, const FreeSurface<3>&, MacGeometry<3>&);
template void set_distance_factor_to_air<2>(const MacDomain<2>&, const FreeSurface<2>&,
                                            MacGeometry<2>&);
template void set_distance_factor_to_air<3>(const MacDomain<3>&, const FreeSurface<3>&,
                                            MacGeometry<3>&);

}  // namespace lockstep
