#include "staggered/state/covered_sides.hpp"

#include <algorithm>

namespace lockstep {

namespace {

/// `cell` is the fluid cell beside the side.
template <int dim>
ControlVolume<dim> volume_at_side(const MacDomain<dim>& domain, const MacGeometry<dim>& geometry,
                                  int axis, int end, int cell) {
  const double half = 0.5 * domain.spacing();
  const Point<dim> inner = domain.grid.center(cell);
  ControlVolume<dim> volume;
  volume.direction = axis;
  volume.center = inner + (end == 0 ? -half : half) * Point<dim>::Unit(axis);
  volume.open_center = volume.center;
  volume.density = geometry.face_table.regular().density;
  volume.area = geometry.face_table.area();
  volume.at_prescribed_side = true;
  volume.sides[end].kind = SideKind::closed;
  volume.sides[1 - end].kind = SideKind::unknown;
  volume.sides[1 - end].unknown = geometry.unknown[cell];
  volume.sides[1 - end].cell = domain.grid.global_id(cell);
  volume.sides[1 - end].center = inner;
  volume.sides[end].center = volume.center;
  Point<dim> across = Point<dim>::Constant(half);
  across[axis] = 0;
  volume.box = Box<dim>(inner - across, inner + across);
  volume.box.extend(volume.center - across);
  volume.box.extend(volume.center + across);
  return volume;
}

/// True if a closed solid that touches the face goes through the side there, or through an inflow.
template <int dim>
bool any_goes_through(const MacDomain<dim>& domain, const SurfaceSnapshot<dim>& surface,
                      const ControlVolume<dim>& volume, int end) {
  if (!domain.boundary.side(volume.direction, end).closed())
    return true;  // fluid comes in there: nothing lies on it
  std::vector<int> solids;
  surface.solids_touching(volume.box, solids);
  return std::any_of(solids.begin(), solids.end(), [&](int solid) {
    return surface.solids()[solid].closed &&
           goes_through<dim>(domain, surface, solid, volume.direction, end);
  });
}

}  // namespace

template <int dim>
bool goes_through(const MacDomain<dim>& domain, const SurfaceSnapshot<dim>& surface, int solid,
                  int axis, int end) {
  const TiledGrid<dim>& grid = domain.grid;
  const double beyond = 0.1 * grid.spacing();
  const Box<dim> bounds = surface.bounds_of_solid(solid);
  const double lower = grid.lower()[axis];
  return end == 0 ? bounds.min()[axis] < lower - beyond
                  : bounds.max()[axis] > lower + grid.n_cells()[axis] * grid.spacing() + beyond;
}

template <int dim>
void add_covered_sides(const MacDomain<dim>& domain, const OpenFractionRule<dim>& rule,
                       MacGeometry<dim>& geometry) {
  const auto& cells = geometry.state.cells;
  domain.grid.for_each_owned_cell_with_neighbors([&](int cell, const auto& neighbors) {
    if (!geometry.near_surface(cell) || cells[cell] != CellState::fluid)
      return;
    for (int axis = 0; axis < dim; ++axis) {
      for (int end = 0; end < 2; ++end) {
        const int other = neighbors[2 * axis + end];
        const bool at_side = other < 0 || cells[other] == CellState::outside;
        if (!at_side || !domain.boundary.side(axis, end).prescribed())
          continue;
        auto volume = volume_at_side(domain, geometry, axis, end, cell);
        volume.open_fraction = rule.open_fraction(volume, false, *geometry.state.surface);
        if (volume.open_fraction >= 1 ||
            !any_goes_through(domain, *geometry.state.surface, volume, end))
          continue;
        if (volume.open_fraction > 0)
          volume.open_center = rule.open_center(volume, *geometry.state.surface);
        geometry.coupled_volumes.push_back(volume);
        if (const int face = end == 0 ? cell : other; face >= 0)
          geometry.face_table.set_open(axis, face, volume.open_fraction);
      }
    }
  });
}

template bool goes_through<2>(const MacDomain<2>&, const SurfaceSnapshot<2>&, int, int, int);
template bool goes_through<3>(const MacDomain<3>&, const SurfaceSnapshot<3>&, int, int, int);
template void add_covered_sides<2>(const MacDomain<2>&, const OpenFractionRule<2>&,
                                   MacGeometry<2>&);
template void add_covered_sides<3>(const MacDomain<3>&, const OpenFractionRule<3>&,
                                   MacGeometry<3>&);

}  // namespace lockstep
