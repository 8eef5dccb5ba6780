#pragma once
#include <memory>
#include <vector>

#include "multigrid/block_neighbors.hpp"

namespace lockstep {

/// A level with one cell a block, in blocks of its own on fewer ranks: where a rank has little left
/// to sweep, messages cost more than the work.
struct GatheredBlocks {
  std::shared_ptr<const LatticeBlocks> blocks;  ///< their lattice is that level
  int rank_stride = 1;                          ///< ranks 0, rank_stride, ... hold them

  /// The rank that holds a cell of that lattice.
  int holder_of(const std::array<int, 3>& cell) const;
};

/// True if the next coarser level can be gathered: images behind periodic sides must be whole
/// blocks.
bool can_gather(const LatticeBlocks& finer);

/// Blocks in lexicographic order, dealt out evenly.
GatheredBlocks gather_blocks(const LatticeBlocks& finer, int rank_stride);

/// Between that level as the ranks of the finer blocks see it (`landing`: their own cells, and the
/// next beyond faces as ghosts) and as its holders store it (`held`). Collective.
std::vector<LevelHalo::Peer> landing_peers(const LatticeBlocks& finer, const LevelGrid& landing,
                                           const GatheredBlocks& gathered, const LevelGrid& held);

}  // namespace lockstep
