#pragma once
#include <vector>

#include "grid/tile_lattice.hpp"

namespace lockstep {

/// The work of tiles, in those of a cell. The two are done in parts of a step that wait for each
/// other, so that each is to be shared evenly.
struct TileWork {
  std::vector<GlobalIndex> everywhere;   ///< work of each tile, at least 1 is taken
  std::vector<GlobalIndex> at_surfaces;  ///< work that surfaces add in each tile; empty: none
};

/// Divides tiles among `n_parts` ranks so that the work is even and the cut small: of some ways the
/// one with the least `partition_cost`. They are METIS on the graph of face neighbours (for either
/// work, and for the first alone), straight cuts, and a cut of the Morton curve. `tile_numbers`
/// ascending. Returns the part of each tile; parts may be empty when there are few tiles. Not
/// collective; deterministic. Throws InputError if there are more tiles than METIS can number.
template <int dim>
std::vector<int> partition_tiles(const TileLattice<dim>& lattice,
                                 const std::vector<GlobalIndex>& tile_numbers, const TileWork& work,
                                 int n_parts);

/// Cost of a step on the slowest rank, in cells: the most work of either kind, and one for every
/// face between cells of two ranks.
template <int dim>
double partition_cost(const TileLattice<dim>& lattice, const std::vector<GlobalIndex>& tile_numbers,
                      const TileWork& work, const std::vector<int>& parts, int n_parts);

}  // namespace lockstep
