#pragma once
#include <vector>

#include "grid/tiled_grid.hpp"

namespace lockstep {

/// Calls f(cell) for the cells of the domain in a tile.
template <int dim, typename Function>
void for_each_cell_of_tile(const TiledGrid<dim>& grid, int tile, const Function& f) {
  const Index<dim>& n = grid.tile_domain_extent(tile);
  const int n_z = dim == 3 ? n[dim - 1] : 1;
  for (int z = 0; z < n_z; ++z)
    for (int y = 0; y < n[1]; ++y) {
      const int first = (tile << log_tile_volume<dim>)+(z * tile_width<dim> + y) * tile_width<dim>;
      for (int cell = first; cell < first + n[0]; ++cell)
        f(cell);
    }
}

/// Calls f for the cells of the owned tiles that are flagged; the flags may be of stored tiles.
template <int dim, typename Function>
void for_each_owned_cell_of(const TiledGrid<dim>& grid, const std::vector<char>& tiles,
                            const Function& f) {
  for (int tile = 0; tile < grid.n_owned_tiles(); ++tile)
    if (tiles[tile])
      for_each_cell_of_tile(grid, tile, f);
}

/// Calls f for the cells of the stored tiles that are flagged.
template <int dim, typename Function>
void for_each_stored_cell_of(const TiledGrid<dim>& grid, const std::vector<char>& tiles,
                             const Function& f) {
  for (int tile = 0; tile < grid.n_tiles(); ++tile)
    if (tiles[tile])
      for_each_cell_of_tile(grid, tile, f);
}

}  // namespace lockstep
