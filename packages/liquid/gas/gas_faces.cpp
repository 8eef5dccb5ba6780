#include "liquid/gas/gas_faces.hpp"

#include "liquid/gas/gas_bubbles.hpp"

namespace lockstep {

template <int dim>
std::vector<GasFace> find_gas_faces(const MacDomain<dim>& domain,
                                    const MacGeometry<dim>& geometry) {
  std::vector<GasFace> result;
  const auto& cells = geometry.state.cells;
  const double unit = geometry.face_table.unit_coefficient(), area = geometry.face_table.area();
  int row = -1;
  domain.grid.for_each_owned_cell_with_neighbors([&](int cell, const auto& neighbors) {
    if (cells[cell] != CellState::fluid)
      return;
    ++row;
    for (int axis = 0; axis < dim; ++axis)
      for (int end = 0; end < 2; ++end) {
        const int other = neighbors[2 * axis + end];
        if (other < 0 || geometry.bubble[other] < 0 || cells[other] != CellState::air)
          continue;
        const int face = end == 0 ? cell : other;
        const double open = geometry.open_fraction(axis, face);
        if (open > 0)
          result.push_back({geometry.bubble[other],
                            row,
                            {axis, face},
                            end == 1 ? 1. : -1.,
                            unit * geometry.face_table(axis, face).coefficient,
                            open * area});
      }
  });
  return result;
}

bool only_gas_beside(const std::vector<CellState>& cells, const std::vector<int>& bubble,
                     const FaceCells& face) {
  if (bubble.empty() || face.at_side())
    return false;
  const auto gas = [&](int cell) { return cells[cell] == CellState::air ? bubble[cell] : -1; };
  return cells[face.lower] != CellState::fluid && cells[face.upper] != CellState::fluid &&
         gas(face.lower) != gas(face.upper);
}

template <int dim>
void find_bubbles(const FreeSurface<dim>& free_surface, const SurfaceMarks<dim>& marks,
                  const std::array<CellField, dim>& fractions, MacGeometry<dim>& geometry) {
  SolidCells<dim> voids;
  voids.state.surface = geometry.state.surface;
  voids.state.cells = geometry.state.cells;
  for (CellState& cell : voids.state.cells)
    if (cell == CellState::air)
      cell = CellState::fluid;
  voids.occluded = marks.occluded;
  voids.near = geometry.near;
  // In cut cells every open part connects, also past a body that hides one centre from the other.
  for (int axis = 0; axis < dim; ++axis)
    for (std::size_t face = 0; face < fractions[axis].size(); ++face) {
      const int bit = 1 << axis, others = voids.occluded[face] & ~bit;
      voids.occluded[face] = static_cast<char>(fractions[axis][face] == 0 ? others | bit : others);
    }
  free_surface.gas->find(voids, *free_surface.distance);
  geometry.bubble = free_surface.gas->of_cell();
}

template <int dim>
Momentum<dim> push_of_sides(const MacDomain<dim>& domain, const MacGeometry<dim>& geometry,
                            const std::vector<double>& scaled_pressure) {
  const TiledGrid<dim>& grid = domain.grid;
  const auto& cells = geometry.state.cells;
  const double area = geometry.face_table.area(), half = 0.5 * grid.spacing();
  Momentum<dim> impulse;
  grid.for_each_owned_cell_with_neighbors([&](int cell, const auto& neighbors) {
    if (geometry.bubble[cell] < 0 || cells[cell] != CellState::air)
      return;
    for (int axis = 0; axis < dim; ++axis)
      for (int end = 0; end < 2; ++end) {
        const int other = neighbors[2 * axis + end];
        if (other >= 0 && cells[other] != CellState::outside)
          continue;
        Point<dim> x = grid.center(cell);
        x[axis] += end == 0 ? -half : half;
        impulse.add(x, axis, (end == 0 ? area : -area) * scaled_pressure[geometry.bubble[cell]]);
      }
  });
  return impulse;
}

template std::vector<GasFace> find_gas_faces<2>(const MacDomain<2>&, const MacGeometry<2>&);
template std::vector<GasFace> find_gas_faces<3>(const MacDomain<3>&, const MacGeometry<3>&);
template void find_bubbles<2>(const FreeSurface<2>&, const SurfaceMarks<2>&,
                              const std::array<CellField, 2>&, MacGeometry<2>&);
template void find_bubbles<3>(const FreeSurface<3>&, const SurfaceMarks<3>&,
                              const std::array<CellField, 3>&, MacGeometry<3>&);
template Momentum<2> push_of_sides<2>(const MacDomain<2>&, const MacGeometry<2>&,
                                      const std::vector<double>&);
template Momentum<3> push_of_sides<3>(const MacDomain<3>&, const MacGeometry<3>&,
                                      const std::vector<double>&);

}  // namespace lockstep
