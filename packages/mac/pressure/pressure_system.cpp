#include "mac/pressure/pressure_system.hpp"

#include <Tpetra_Vector.hpp>

namespace lockstep {

namespace {

/// Outflow of a strip of cells whose faces are all regular, per area.
template <int dim>
StripValues<dim> outflow_of_row(const FaceField<dim>& velocity, const CellStrip<dim>& cells) {
  const StripValues<dim> along = row_of<dim>(velocity[0].data(), cells.begin);
  StripValues<dim> outflow = row_ahead<dim>(along, velocity[0][cells.neighbors[1]]) - along;
  for (int axis = 1; axis < dim; ++axis)
    outflow += row_of<dim>(velocity[axis].data(), cells.neighbors[2 * axis + 1]) -
               row_of<dim>(velocity[axis].data(), cells.begin);
  return outflow;
}

/// The jumps of a field across a row of faces normal to `axis`; `below` is the cell or row below
/// the first.
template <int dim>
StripValues<dim> jumps_of_row(const double* field, int axis, int first, int below) {
  const StripValues<dim> row = row_of<dim>(field, first);
  if (axis > 0)
    return row - row_of<dim>(field, below);
  return row - row_behind<dim>(row, field[below]);
}

}  // namespace

template <int dim>
void outflow_deficit(const MacDomain<dim>& domain, const MacGeometry<dim>& geometry,
                     const FaceField<dim>& velocity, Vector& rhs) {
  const auto values = rhs.getDataNonConst();
  const double area = geometry.face_table.area();
  int row = 0;
  const auto add_cell = [&](int cell, const auto& neighbors) {
    if (geometry.state.cells[cell] != CellState::fluid)
      return;
    double outflow = 0;
    for (int axis = 0; axis < dim; ++axis) {
      const int upper = neighbors[2 * axis + 1];
      const double open_upper = upper < 0 ? 0 : geometry.flux_fraction(axis, upper);
      if (open_upper != 0)
        outflow += open_upper * velocity[axis][upper];
      outflow -= geometry.flux_fraction(axis, cell) * velocity[axis][cell];
    }
    values[row++] = -area * outflow;
  };
  domain.grid.for_each_owned_strip([&](const CellStrip<dim>& cells) {
    if (geometry.has_regular_faces(cells)) {
      row_of<dim>(values.getRawPtr(), row) = -area * outflow_of_row<dim>(velocity, cells);
      row += tile_width<dim>;
    } else {
      cells.for_each_cell(add_cell);
    }
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
                       const CellField& scaled_pressure, FaceField<dim>& velocity) {
  const double regular = geometry.face_table.regular().gradient;
  for (int axis = 0; axis < dim; ++axis) {
    const auto subtract_one = [&](int cell) {
      if (geometry.state.faces[axis][cell] != FaceState::free)
        return;
      // Outside of the fluid the field is zero.
      const int lower = domain.grid.neighbor(cell, axis, 0);
      const double jump = scaled_pressure[cell] - (lower < 0 ? 0 : scaled_pressure[lower]);
      velocity[axis][cell] -= geometry.face_table(axis, cell).gradient * jump;
    };
    domain.grid.for_each_owned_face_row(axis, [&](int first, int n, int below) {
      if (n == tile_width<dim> && below >= 0 && geometry.has_regular_faces(axis, first)) {
        row_of<dim>(velocity[axis].data(), first) -=
            regular * jumps_of_row<dim>(scaled_pressure.data(), axis, first, below);
        return;
      }
      for (int cell = first; cell < first + n; ++cell)
        subtract_one(cell);
    });
  }
}

/// Impulse of prescribed sides on the fluid of this rank's cells, as if no solid covered them.
template <int dim>
Momentum<dim> whole_side_impulse(const MacDomain<dim>& domain, const MacGeometry<dim>& geometry,
                                 const double* values, GlobalIndex first_unknown) {
  const TiledGrid<dim>& grid = domain.grid;
  const double area = geometry.face_table.area(), half = 0.5 * grid.spacing();
  Momentum<dim> impulse;
  // Closed upper sides have no stored face, so this goes by cells.
  grid.for_each_owned_strip([&](const CellStrip<dim>& row) {
    for (int axis = 0; axis < dim; ++axis)
      for (int end = 0; end < 2; ++end) {
        const int other = row.neighbors[2 * axis + end];
        const bool at_side = other < 0 || geometry.state.cells[other] == CellState::outside;
        if (!at_side || !domain.boundary.side(axis, end).prescribed())
          continue;
        const int begin = axis == 0 && end == 1 ? row.begin + row.n - 1 : row.begin;
        const int n = axis == 0 ? 1 : row.n;
        for (int cell = begin; cell < begin + n; ++cell) {
          if (geometry.state.cells[cell] != CellState::fluid)
            continue;
          Point<dim> x = grid.center(cell);
          x[axis] += end == 0 ? -half : half;
          impulse.add(x, axis,
                      (end == 0 ? area : -area) * values[geometry.unknown[cell] - first_unknown]);
        }
      }
  });
  return impulse;
}

/// Impulse of closed sides on the patches where solids touch them.
template <int dim>
Momentum<dim> patch_impulse(const MacGeometry<dim>& geometry,
                            const std::vector<double>& pressure_of_node) {
  Momentum<dim> impulse;
  for (const ControlVolume<dim>& volume : geometry.coupled_volumes)
    for (int end = 0; end < 2 && volume.at_prescribed_side; ++end)
      if (const int node = volume.sides[end].patch; node >= 0)
        impulse.add(volume.center, volume.direction,
                    (end == 0 ? volume.area : -volume.area) * pressure_of_node[node]);
  return impulse;
}

template <int dim>
Momentum<dim> side_pressure_impulse(const MacDomain<dim>& domain, const MacGeometry<dim>& geometry,
                                    const Vector& scaled_pressure) {
  const auto values = scaled_pressure.getData();
  const double area = geometry.face_table.area();
  const GlobalIndex first_unknown =
      values.size() > 0 ? geometry.pressure_map->getMinGlobalIndex() : 0;
  Momentum<dim> impulse = whole_side_impulse(domain, geometry, values.getRawPtr(), first_unknown);
  if (geometry.contact_patches)
    impulse += patch_impulse(geometry, geometry.contact_patches->extended(scaled_pressure));
  // The pressure of a side's part that solids cover acts on these; only the rest is the side's.
  for (std::size_t i = geometry.coupled.size(); i < geometry.coupled_volumes.size(); ++i) {
    const ControlVolume<dim>& volume = geometry.coupled_volumes[i];
    if (!volume.at_prescribed_side || volume.touches_patch())
      continue;
    const int end = volume.sides[0].unknown == no_index ? 0 : 1;
    const double push =
        (end == 0 ? area : -area) * values[volume.sides[1 - end].unknown - first_unknown];
    impulse.add(volume.center, volume.direction, -push);
    impulse.add(volume.open_center, volume.direction, volume.open_fraction * push);
  }
  return sum_over_ranks(impulse, domain.grid.comm());
}

template void outflow_deficit<2>(const MacDomain<2>&, const MacGeometry<2>&, const FaceField<2>&,
                                 Vector&);
template void outflow_deficit<3>(const MacDomain<3>&, const MacGeometry<3>&, const FaceField<3>&,
                                 Vector&);
template CellField pressure_field<2>(const MacDomain<2>&, const MacGeometry<2>&, const Vector&);
template CellField pressure_field<3>(const MacDomain<3>&, const MacGeometry<3>&, const Vector&);
template void subtract_gradient<2>(const MacDomain<2>&, const MacGeometry<2>&, const CellField&,
                                   FaceField<2>&);
template void subtract_gradient<3>(const MacDomain<3>&, const MacGeometry<3>&, const CellField&,
                                   FaceField<3>&);
template Momentum<2> side_pressure_impulse<2>(const MacDomain<2>&, const MacGeometry<2>&,
                                              const Vector&);
template Momentum<3> side_pressure_impulse<3>(const MacDomain<3>&, const MacGeometry<3>&,
                                              const Vector&);

}  // namespace lockstep
