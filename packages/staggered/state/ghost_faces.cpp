#include "staggered/state/ghost_faces.hpp"

namespace lockstep {

namespace {
/// UncoveredSamples looks from its own faces at the neighbours, which may be other ranks'.
template <int dim>
void share_open_centers(const MacDomain<dim>& domain, int axis, GridState<dim>& state) {
  const TiledGrid<dim>& grid = domain.grid;
  auto& places = state.open_centers[axis];
  std::array<CellField, dim> shift;
  for (int a = 0; a < dim; ++a) {
    shift[a].assign(grid.n_stored_cells(), 0.0);
    for (const auto& [face, place] : places)
      shift[a][face] = place[a] - grid.face_center(axis, face)[a];
    domain.halo.fill(shift[a]);
  }
  for (int face = grid.n_owned_cells(); face < grid.n_stored_cells(); ++face) {
    Point<dim> beside;
    for (int a = 0; a < dim; ++a)
      beside[a] = shift[a][face];
    if (beside != Point<dim>::Zero())
      places[face] = grid.face_center(axis, face) + beside;
  }
}
}  // namespace

template <int dim>
void complete_ghost_faces(const MacDomain<dim>& domain, MacGeometry<dim>& geometry) {
  const TiledGrid<dim>& grid = domain.grid;
  const GridState<dim>& state = geometry.state;
  for (int axis = 0; axis < dim; ++axis) {
    if (domain.boundary.side(axis, 1).type != SideType::open)
      continue;
    for (int cell = grid.n_owned_cells(); cell < grid.n_stored_cells(); ++cell)
      if (state.cells[cell] == CellState::outside && state.faces[axis][cell] == FaceState::free)
        geometry.face_table.set_distance_factor(axis, cell, 2);
  }
}

template <int dim>
void share_open_fractions(const MacDomain<dim>& domain, MacGeometry<dim>& geometry) {
  const TiledGrid<dim>& grid = domain.grid;
  if (!geometry.state.surface || grid.comm()->getSize() == 1)
    return;
  std::array<double, dim> n_partial{};
  for (const ControlVolume<dim>& volume : geometry.coupled_volumes)
    n_partial[volume.direction] += volume.open_fraction > 0;
  for (const auto& [axis, cell] : geometry.prescribed)
    n_partial[axis] += geometry.face_table(axis, cell).open < 1;
  sum_over_ranks(grid.comm(), n_partial);
  for (int axis = 0; axis < dim; ++axis) {
    if (n_partial[axis] == 0)
      continue;
    CellField open(grid.n_stored_cells());
    for (int cell = 0; cell < grid.n_owned_cells(); ++cell)
      open[cell] = geometry.face_table(axis, cell).open;
    std::fill(open.begin() + grid.n_owned_cells(), open.end(), 1.0);
    domain.halo.fill(open);
    for (int cell = grid.n_owned_cells(); cell < grid.n_stored_cells(); ++cell)
      if (open[cell] < 1)
        geometry.face_table.set_open(axis, cell, open[cell]);
    share_open_centers(domain, axis, geometry.state);
  }
}

template void complete_ghost_faces<2>(const MacDomain<2>&, MacGeometry<2>&);
template void complete_ghost_faces<3>(const MacDomain<3>&, MacGeometry<3>&);
template void share_open_fractions<2>(const MacDomain<2>&, MacGeometry<2>&);
template void share_open_fractions<3>(const MacDomain<3>&, MacGeometry<3>&);

}  // namespace lockstep
