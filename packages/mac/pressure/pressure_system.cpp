#include "mac/pressure/pressure_system.hpp"

#include <Tpetra_Vector.hpp>

namespace lockstep {

namespace {
/// Distance of the two pressure points of a face in units of h.
double pressure_distance(const FaceCells& face) {
  return face.at_side() ? 0.5 : 1.0;
}

/// The part of a face through which the fluid leaves with the face's own velocity.
template <int dim>
double flux_fraction(const MacGeometry<dim>& geometry, int axis, int face) {
  if (face < 0)
    return 0;
  if (geometry.state.faces[axis][face] == FaceState::prescribed)
    return geometry.open_part_of_prescribed(axis, face);
  return geometry.open_fraction(axis, face);
}
}  // namespace

template <int dim>
void outflow_deficit(const MacDomain<dim>& domain, const MacGeometry<dim>& geometry,
                     const FaceField<dim>& velocity, Vector& rhs) {
  const auto values = rhs.getDataNonConst();
  const double area = domain.face_area();
  int row = 0;
  domain.grid.for_each_owned_cell_with_neighbors([&](int cell, const auto& neighbors) {
    if (geometry.state.cells[cell] != CellState::fluid)
      return;
    double outflow = 0;
    for (int axis = 0; axis < dim; ++axis) {
      const int upper = neighbors[2 * axis + 1];
      const double open_upper = flux_fraction(geometry, axis, upper);
      if (open_upper != 0)
        outflow += open_upper * velocity[axis][upper];
      outflow -= flux_fraction(geometry, axis, cell) * velocity[axis][cell];
    }
    values[row++] = -area * outflow;
  });
}

template <int dim>
CellField pressure_field(const MacDomain<dim>& domain, const MacGeometry<dim>& geometry,
                         const Vector& scaled_pressure) {
  const auto values = scaled_pressure.getData();
  CellField field(domain.grid.n_stored_cells(), 0.0);
  int row = 0;
  domain.grid.for_each_owned_cell([&](int cell) {
    if (geometry.state.cells[cell] == CellState::fluid)
      field[cell] = values[row++];
  });
  domain.halo.fill(field);
  return field;
}

template <int dim>
void subtract_gradient(const MacDomain<dim>& domain, const MacGeometry<dim>& geometry,
                       double density, const CellField& scaled_pressure, FaceField<dim>& velocity) {
  const double unit = 1 / (density * domain.spacing());
  for (int axis = 0; axis < dim; ++axis)
    domain.grid.for_each_owned_face(axis, [&](int cell) {
      if (geometry.state.faces[axis][cell] != FaceState::free)
        return;
      const FaceCells face = cells_of_face(domain.grid, geometry.state.cells, axis, cell);
      const double upper = face.upper < 0 ? 0 : scaled_pressure[face.upper];
      const double lower = face.lower < 0 ? 0 : scaled_pressure[face.lower];
      velocity[axis][cell] -= unit / pressure_distance(face) * (upper - lower);
    });
}

template <int dim>
Momentum<dim> side_pressure_impulse(const MacDomain<dim>& domain, const MacGeometry<dim>& geometry,
                                    const Vector& scaled_pressure) {
  const TiledGrid<dim>& grid = domain.grid;
  const auto values = scaled_pressure.getData();
  const double area = domain.face_area(), half = 0.5 * grid.spacing();
  Momentum<dim> impulse;
  int row = 0;
  // Closed upper sides have no stored face, so this goes by cells.
  grid.for_each_owned_cell_with_neighbors([&](int cell, const auto& neighbors) {
    if (geometry.state.cells[cell] != CellState::fluid)
      return;
    const double pressure = values[row++];
    for (int axis = 0; axis < dim; ++axis)
      for (int end = 0; end < 2; ++end) {
        const int other = neighbors[2 * axis + end];
        const bool at_side = other < 0 || geometry.state.cells[other] == CellState::outside;
        if (!at_side || !domain.boundary.side(axis, end).prescribed())
          continue;
        Point<dim> x = grid.center(cell);
        x[axis] += end == 0 ? -half : half;
        impulse.add(x, axis, (end == 0 ? area : -area) * pressure);
      }
  });
  // What solids cover of a side they push on themselves; only the rest is the side's.
  const GlobalIndex first_unknown =
      values.size() > 0 ? geometry.pressure_map->getMinGlobalIndex() : 0;
  for (std::size_t i = geometry.coupled.size(); i < geometry.volumes.size(); ++i) {
    const ControlVolume<dim>& volume = geometry.volumes[i];
    const int end = volume.sides[0].unknown == no_index ? 0 : 1;
    const double push =
        (end == 0 ? area : -area) * values[volume.sides[1 - end].unknown - first_unknown];
    impulse.add(volume.center, volume.direction, -push);
    impulse.add(volume.open_center, volume.direction, volume.open_fraction * push);
  }
  return sum_over_ranks(impulse, grid.comm());
}

template void outflow_deficit<2>(const MacDomain<2>&, const MacGeometry<2>&, const FaceField<2>&,
                                 Vector&);
template void outflow_deficit<3>(const MacDomain<3>&, const MacGeometry<3>&, const FaceField<3>&,
                                 Vector&);
template CellField pressure_field<2>(const MacDomain<2>&, const MacGeometry<2>&, const Vector&);
template CellField pressure_field<3>(const MacDomain<3>&, const MacGeometry<3>&, const Vector&);
template void subtract_gradient<2>(const MacDomain<2>&, const MacGeometry<2>&, double,
                                   const CellField&, FaceField<2>&);
template void subtract_gradient<3>(const MacDomain<3>&, const MacGeometry<3>&, double,
                                   const CellField&, FaceField<3>&);
template Momentum<2> side_pressure_impulse<2>(const MacDomain<2>&, const MacGeometry<2>&,
                                              const Vector&);
template Momentum<3> side_pressure_impulse<3>(const MacDomain<3>&, const MacGeometry<3>&,
                                              const Vector&);

}  // namespace lockstep
