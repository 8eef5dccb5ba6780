#include "liquid/surface/free_surface.hpp"

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
template void set_distance_factor_to_air<2>(const MacDomain<2>&, const FreeSurface<2>&,
                                            MacGeometry<2>&);
template void set_distance_factor_to_air<3>(const MacDomain<3>&, const FreeSurface<3>&,
                                            MacGeometry<3>&);

}  // namespace lockstep
