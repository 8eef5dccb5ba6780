#include "staggered/state/cut_cells.hpp"

#include <algorithm>

namespace lockstep {

namespace {

/// The box of a cell between the planes of its faces (`TiledGrid::face_center`).
template <int dim>
Box<dim> box_of_cell(const TiledGrid<dim>& grid, int cell) {
  const Index<dim> place = grid.coordinates(cell);
  Box<dim> box;
  for (int a = 0; a < dim; ++a) {
    box.min()[a] = grid.lower()[a] + place[a] * grid.spacing();
    box.max()[a] = grid.lower()[a] + (place[a] + 1) * grid.spacing();
  }
  return box;
}

template <int dim>
bool touches_soft_body(const SurfaceSnapshot<dim>& surface, const Box<dim>& box,
                       std::vector<int>& touching) {
  surface.touching(box, touching);
  return std::any_of(touching.begin(), touching.end(), [&](int simplex) {
    return surface.solids()[surface.solid_of(simplex)].is_soft_body();
  });
}

}  // namespace

template <int dim>
std::vector<CutCell<dim>> find_cut_cells(const MacDomain<dim>& domain,
                                         const MacGeometry<dim>& geometry) {
  const TiledGrid<dim>& grid = domain.grid;
  const SurfaceSnapshot<dim>& surface = *geometry.state.surface;
  std::vector<CutCell<dim>> found;
  std::vector<int> touching, of_others;
  const auto look_at = [&](int cell) {
    const bool has_unknown = geometry.unknown[cell] != no_index;
    const Box<dim> box = box_of_cell(grid, cell);
    if ((!has_unknown && !geometry.in_bubble(cell)) ||
        !touches_soft_body<dim>(surface, box, touching))
      return;
    CutCell<dim> cut;
    cut.box = box;
    cut.pressure.kind = has_unknown ? SideKind::unknown : SideKind::air;
    cut.pressure.unknown = geometry.unknown[cell];
    cut.pressure.center = grid.center(cell);
    cut.pressure.cell = grid.global_id(cell);
    cut.pressure.bubble = has_unknown ? -1 : geometry.bubble[cell];
    cut.is_owned = grid.owned(cell);
    found.push_back(cut);
  };
  const auto& solids = surface.solids();
  if (std::none_of(solids.begin(), solids.end(),
                   [](const SolidDescription& solid) { return solid.is_soft_body(); }))
    return found;
  grid.for_each_owned_cell_with_neighbors([&](int cell, const auto& neighbors) {
    if (geometry.near_surface(cell))
      look_at(cell);
    for (int axis = 0; axis < dim; ++axis)
      if (const int below = neighbors[2 * axis]; below >= 0 && !grid.owned(below))
        of_others.push_back(below);
  });
  std::sort(of_others.begin(), of_others.end());
  of_others.erase(std::unique(of_others.begin(), of_others.end()), of_others.end());
  for (const int cell : of_others)
    look_at(cell);
  return found;
}

template std::vector<CutCell<2>> find_cut_cells<2>(const MacDomain<2>&, const MacGeometry<2>&);
template std::vector<CutCell<3>> find_cut_cells<3>(const MacDomain<3>&, const MacGeometry<3>&);

}  // namespace lockstep
