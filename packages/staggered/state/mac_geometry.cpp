#include "staggered/state/mac_geometry.hpp"

namespace lockstep {

namespace {
template <int dim>
PressureSide<dim> pressure_side(const TiledGrid<dim>& grid, const MacGeometry<dim>& geometry,
                                int cell, const Point<dim>& center) {
  PressureSide<dim> side;
  side.center = center;
  if (cell < 0)
    return side;
  side.cell = grid.global_id(cell);
  side.unknown = geometry.unknown[cell];
  side.kind = SideKind::unknown;
  if (geometry.state.cells[cell] == CellState::solid) {
    side.kind = SideKind::solid;
    side.solid = solid_of_cell(*geometry.state.surface, center, grid.spacing());
  } else if (geometry.state.cells[cell] == CellState::air) {
    side.kind = SideKind::air;
    side.bubble = geometry.bubble.empty() ? -1 : geometry.bubble[cell];
  }
  return side;
}

/// Faces in the plane where a periodic axis closes lie at its lower end, unless a solid is in their
/// half of the last cell alone: it is not repeated, so that only there the face meets it.
template <int dim>
Point<dim> center_of_face(const MacDomain<dim>& domain, const MacGeometry<dim>& geometry, int axis,
                          int cell) {
  const TiledGrid<dim>& grid = domain.grid;
  const Point<dim> center = grid.face_center(axis, cell);
  if (!geometry.state.surface || !grid.description().periodic[axis] ||
      grid.coordinates(cell)[axis] != 0)
    return center;
  const Point<dim> half = Point<dim>::Unit(axis) * (0.5 * grid.spacing());
  const Point<dim> at_upper_end =
      center + Point<dim>::Unit(axis) * (grid.n_cells()[axis] * grid.spacing());
  const SurfaceSnapshot<dim>& surface = *geometry.state.surface;
  const bool is_above = surface.inside(at_upper_end - half) >= 0 ||
                        (surface.first_hit(at_upper_end - half, at_upper_end) &&
                         !surface.first_hit(center, center + half));
  return is_above && surface.inside(center + half) < 0 ? at_upper_end : center;
}
}  // namespace

template <int dim>
int solid_of_cell(const SurfaceSnapshot<dim>& surface, const Point<dim>& center, double spacing) {
  int nearest = surface.inside(center);
  if (nearest >= 0)
    return nearest;
  const Point<dim> reach = Point<dim>::Constant(spacing);
  std::vector<int> solids;
  surface.solids_touching(Box<dim>(center - reach, center + reach), solids);
  double least = 2 * spacing;
  for (const int solid : solids) {
    if (!surface.solids()[solid].closed)
      continue;
    const double distance = surface.closest_on_solid(center, solid).fraction;
    if (distance < least) {
      least = distance;
      nearest = solid;
    }
  }
  return nearest;
}

template <int dim>
ControlVolume<dim> control_volume(const MacDomain<dim>& domain, const MacGeometry<dim>& geometry,
                                  int axis, int cell) {
  const TiledGrid<dim>& grid = domain.grid;
  const FaceCells face = cells_of_face(grid, geometry.state.cells, axis, cell);
  const double half = 0.5 * grid.spacing();
  ControlVolume<dim> volume;
  volume.direction = axis;
  volume.center = center_of_face(domain, geometry, axis, cell);
  volume.open_center = volume.center;
  volume.density = geometry.face_table.regular().density;
  volume.area = geometry.face_table.area();
  volume.id = dim * grid.global_id(cell) + axis;
  const Point<dim> step = Point<dim>::Unit(axis) * half;
  const Point<dim> lower = face.lower < 0 ? volume.center : Point<dim>(volume.center - step);
  const Point<dim> upper = face.upper < 0 ? volume.center : Point<dim>(volume.center + step);
  volume.sides = {pressure_side(grid, geometry, face.lower, lower),
                  pressure_side(grid, geometry, face.upper, upper)};
  Point<dim> across = Point<dim>::Constant(half);
  across[axis] = 0;
  volume.box = Box<dim>(lower - across, upper + across);
  return volume;
}

template struct MacGeometry<2>;
template struct MacGeometry<3>;
template int solid_of_cell<2>(const SurfaceSnapshot<2>&, const Point<2>&, double);
template int solid_of_cell<3>(const SurfaceSnapshot<3>&, const Point<3>&, double);
template ControlVolume<2> control_volume<2>(const MacDomain<2>&, const MacGeometry<2>&, int, int);
template ControlVolume<3> control_volume<3>(const MacDomain<3>&, const MacGeometry<3>&, int, int);

}  // namespace lockstep
