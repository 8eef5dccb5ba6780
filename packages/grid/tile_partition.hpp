#pragma once
#include <vector>

#include "grid/tile_lattice.hpp"

namespace lockstep {

/// Divides tiles among `n_parts` ranks so that the work is even and the cut small: METIS on the
/// graph of face neighbours, or a cut of the Morton curve where METIS leaves a small graph uneven.
/// `tile_numbers` ascending, `weights` the work of each (at least 1 is taken). Returns the part of
/// each tile; parts may be empty when there are few tiles. Not collective; deterministic. Throws
/// InputError if there are more tiles than METIS can number.
template <int dim>
std::vector<int> partition_tiles(const TileLattice<dim>& lattice,
                                 const std::vector<GlobalIndex>& tile_numbers,
                                 const std::vector<GlobalIndex>& weights, int n_parts);

}  // namespace lockstep
