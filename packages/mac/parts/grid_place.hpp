#pragma once
#include <cmath>
#include <limits>

#include "transport/sample_lattice.hpp"

namespace lockstep {

/// Place of a point on the grid: its cell, and its distance from the lower corner [cells].
template <int dim>
struct GridPlace {
  int cell = -1;
  Point<dim> x;
};

/// Sides belong to the cells beside them, upper ones too; round-off may put a point beyond.
template <int dim>
GridPlace<dim> place_of(const TiledGrid<dim>& grid, const Point<dim>& point) {
  Point<dim> inner = grid.wrap(point);
  const double h = grid.spacing();
  GridPlace<dim> place;
  place.x = (inner - grid.lower()) / h;
  for (int a = 0; a < dim; ++a) {
    const int n = grid.n_cells()[a];
    const double round_off =
        8 * std::numeric_limits<double>::epsilon() * (std::abs(grid.lower()[a]) / h + n);
    for (const int side : {0, n}) {
      if (grid.description().periodic[a] || std::abs(place.x[a] - side) > round_off)
        continue;
      place.x[a] = side;
      inner[a] = grid.lower()[a] + (side == 0 ? 0.5 : n - 0.5) * h;
    }
  }
  place.cell = grid.cell_containing(inner);
  return place;
}

}  // namespace lockstep
