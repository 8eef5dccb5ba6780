#pragma once
#include <optional>
#include <vector>

#include "base/communicator.hpp"
#include "grid/tile_lattice.hpp"
#include "grid/tile_partition.hpp"

namespace lockstep {

/// Existing tiles of the domain and their owners: the same on every rank.
struct TileOwners {
  std::vector<GlobalIndex> tiles;  ///< numbers, ascending
  std::vector<int> ranks;          ///< owner of each tile
};

/// Collective: divides tiles (ascending, the same on all ranks) among the ranks (see
/// `partition_tiles`). `weights` is the work of each in cells. Throws InputError on all ranks.
template <int dim>
TileOwners share_tiles(const TileLattice<dim>& lattice, const Communicator& comm,
                       std::vector<GlobalIndex> tiles, const std::vector<GlobalIndex>& weights);

/// Collective, for a choice of tiles that follows another: tiles that stay keep their rank, a new
/// one goes to the rank that has most of its neighbours, so that little moves. Where a rank then
/// has more than 1.2 times its share of the work, they are divided anew, if that is better.
template <int dim>
TileOwners share_tiles_again(const TileLattice<dim>& lattice, const Communicator& comm,
                             const TileOwners& before, std::vector<GlobalIndex> tiles,
                             const std::vector<GlobalIndex>& weights);

/// Collective: other owners of the same tiles, if with them the slowest rank has at least 7 % less
/// to do; nothing if not. `work` is rank 0's.
template <int dim>
std::optional<TileOwners> share_better(const TileLattice<dim>& lattice, const Communicator& comm,
                                       const TileOwners& before, const TileWork& work);

}  // namespace lockstep
