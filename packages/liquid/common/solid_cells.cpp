#include "liquid/common/solid_cells.hpp"

#include <algorithm>

#include "staggered/state/surface_marks.hpp"

namespace lockstep {

namespace {
/// Frees the faces of the fluid cells of a tile.
template <int dim>
void free_faces(const TiledGrid<dim>& grid, int tile, GridState<dim>& state) {
  const auto first = state.cells.begin() + tile * tile_volume<dim>;
  const bool is_full = std::all_of(first, first + tile_volume<dim>,
                                   [](CellState cell) { return cell == CellState::fluid; });
  for (int axis = 0; axis < dim; ++axis) {
    std::vector<FaceState>& faces = state.faces[axis];
    if (is_full)
      std::fill_n(faces.begin() + tile * tile_volume<dim>, tile_volume<dim>, FaceState::free);
    const int shift = log_tile_width<dim> * axis;
    for (int i = 0, cell = tile * tile_volume<dim>; i < tile_volume<dim>; ++i, ++cell) {
      const bool is_last = (i >> shift) % tile_width<dim> + 1 == tile_width<dim>;
      if (state.cells[cell] != CellState::fluid || (is_full && !is_last))
        continue;
      faces[cell] = FaceState::free;
      const int above = grid.neighbor(cell, axis, 1);
      if (above >= 0)
        faces[above] = FaceState::free;
    }
  }
}
}  // namespace

template <int dim>
SolidCells<dim> find_solid_cells(const MacDomain<dim>& domain,
                                 const std::shared_ptr<const SurfaceSnapshot<dim>>& surface) {
  const TiledGrid<dim>& grid = domain.grid;
  SolidCells<dim> result;
  GridState<dim>& state = result.state;
  state.cells.assign(grid.n_stored_cells(), CellState::outside);
  grid.for_each_stored_cell([&](int cell) { state.cells[cell] = CellState::fluid; });
  if (surface && !surface->empty()) {
    state.surface = surface;
    SurfaceMarks<dim> marks = mark_surface(domain, *surface, state.cells);
    result.occluded = std::move(marks.occluded);
    result.near = std::move(marks.near);
  }
  for (int axis = 0; axis < dim; ++axis)
    state.faces[axis].assign(grid.n_stored_cells(), FaceState::inactive);
  for (int tile = 0; tile < grid.n_tiles(); ++tile)
    free_faces(grid, tile, state);
  return result;
}

template struct SolidCells<2>;
template struct SolidCells<3>;
template SolidCells<2> find_solid_cells<2>(const MacDomain<2>&,
                                           const std::shared_ptr<const SurfaceSnapshot<2>>&);
template SolidCells<3> find_solid_cells<3>(const MacDomain<3>&,
                                           const std::shared_ptr<const SurfaceSnapshot<3>>&);

}  // namespace lockstep
