#pragma once

#include "grid/tiled_grid.hpp"
#include "support/world.hpp"

namespace lockstep::test {

/// 20 x 13 cells: partial tiles on both axes, smaller than four ranks need; x periodic, y with a
/// layer.
inline GridDescription<2> channel_20x13() {
  GridDescription<2> description;
  description.lower = Point<2>(-1, 2);
  description.spacing = 0.5;
  description.n_cells = {20, 13};
  description.periodic = {true, false};
  description.store_upper_face = {false, true};
  return description;
}

/// 40 x 32 x 10 cells of 8^3 tiles: z periodic with a partial tile, upper faces of y in tiles of
/// their own, closed in x.
inline GridDescription<3> channel_40x32x10() {
  GridDescription<3> description;
  description.spacing = 0.25;
  description.n_cells = {40, 32, 10};
  description.periodic = {false, false, true};
  description.store_upper_face = {false, true, false};
  return description;
}

inline GridDescription<2> square(int n, bool periodic) {
  GridDescription<2> description;
  description.n_cells = {n, n};
  description.periodic = {periodic, periodic};
  return description;
}

template <int dim>
Index<dim> shifted(Index<dim> coordinates, int axis, int side) {
  coordinates[axis] += side == 0 ? -1 : 1;
  return coordinates;
}

template <int dim, typename Function>
void for_each_stored_lattice_cell(const TiledGrid<dim>& grid, const Function& f) {
  for (int c = 0; c < grid.n_stored_cells(); ++c)
    if (grid.in_lattice(c))
      f(c);
}

/// A number that differs for every lattice cell.
template <int dim>
double label(const TiledGrid<dim>& grid, int cell) {
  return 1.0 + static_cast<double>(grid.global_id(cell));
}

}  // namespace lockstep::test
