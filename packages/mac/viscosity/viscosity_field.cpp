#include "mac/viscosity/viscosity_field.hpp"

#include <algorithm>

namespace lockstep {

template <int dim>
double ViscosityField<dim>::at(double distance) const {
  const double part = std::clamp(0.5 - distance / domain_.spacing(), 0.0, 1.0);
  if (part == 0 || part == 1)
    return part == 1 ? phases_.liquid : phases_.gas;
  const double product = phases_.liquid * phases_.gas;
  return product == 0 ? 0 : product / (part * phases_.gas + (1 - part) * phases_.liquid);
}

template <int dim>
double ViscosityField<dim>::of_cell(int cell) const {
  if (cells_[cell] != CellState::fluid)
    return 0;
  return phases_.distance ? at((*phases_.distance)[cell]) : 1;
}

template <int dim>
double ViscosityField<dim>::of_edge(const FaceId& face, int across, int end) const {
  if (!phases_.distance)
    return 1;
  const TiledGrid<dim>& grid = domain_.grid;
  double sum = 0;
  int n = 0;
  const FaceCells beside = cells_of_face(grid, cells_, face.axis, face.cell);
  for (const int cell : {beside.lower, beside.upper}) {
    if (cell < 0)
      continue;
    const int other = grid.neighbor(cell, across, end);
    const bool mirrored = other < 0 || cells_[other] == CellState::outside;
    sum += (*phases_.distance)[cell] + (*phases_.distance)[mirrored ? cell : other];
    n += 2;
  }
  return n == 0 ? 0 : at(sum / n);
}

template class ViscosityField<2>;
template class ViscosityField<3>;

}  // namespace lockstep
