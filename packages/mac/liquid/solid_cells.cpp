#include "mac/liquid/solid_cells.hpp"

#include "mac/state/surface_marks.hpp"

namespace lockstep {

template <int dim>
SolidCells<dim> find_solid_cells(const MacDomain<dim>& domain,
                                 const std::shared_ptr<const SurfaceSnapshot<dim>>& surface) {
  const TiledGrid<dim>& grid = domain.grid;
  SolidCells<dim> result;
  MacState<dim>& state = result.state;
  state.cells.assign(grid.n_stored_cells(), CellState::outside);
  grid.for_each_stored_cell([&](int cell) { state.cells[cell] = CellState::fluid; });
  if (surface && !surface->empty()) {
    state.surface = surface;
    SurfaceMarks<dim> marks = mark_surface(domain, *surface, state.cells);
    result.blocked = std::move(marks.blocked);
    result.near = std::move(marks.near);
  }
  for (int axis = 0; axis < dim; ++axis)
    state.faces[axis].assign(grid.n_stored_cells(), FaceState::inactive);
  grid.for_each_stored_cell([&](int cell) {
    if (!result.is_fluid(cell))
      return;
    for (int axis = 0; axis < dim; ++axis) {
      state.faces[axis][cell] = FaceState::free;
      const int above = grid.neighbor(cell, axis, 1);
      if (above >= 0)
        state.faces[axis][above] = FaceState::free;
    }
  });
  return result;
}

template struct SolidCells<2>;
template struct SolidCells<3>;
template SolidCells<2> find_solid_cells<2>(const MacDomain<2>&,
                                           const std::shared_ptr<const SurfaceSnapshot<2>>&);
template SolidCells<3> find_solid_cells<3>(const MacDomain<3>&,
                                           const std::shared_ptr<const SurfaceSnapshot<3>>&);

}  // namespace lockstep
