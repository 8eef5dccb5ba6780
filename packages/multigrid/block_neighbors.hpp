#pragma once
#include <vector>

#include "linear/stencil_operator.hpp"
#include "multigrid/level_grid.hpp"
#include "multigrid/level_halo.hpp"

namespace lockstep {

/// The face of a block that touches another rank's block, or this rank's own through a periodic
/// side.
struct BlockFace {
  std::array<int, 3> begin{};   ///< of the block that owns the cells
  std::array<int, 3> beside{};  ///< of the block on the other side, which holds ghosts of them
  int axis = 0;
  int side = 0;  ///< of the owning block
};

/// What a rank sends to and receives from one rank (maybe itself), in the order of that rank's
/// lists.
struct BlockNeighbors {
  int rank = 0;
  std::vector<BlockFace> owned, ghosts;
};

/// False for blocks wholly beyond the domain.
bool holds_cells(const LatticeBlocks& blocks, const std::array<int, 3>& begin);

/// Collective.
std::vector<BlockNeighbors> find_block_neighbors(const LatticeBlocks& blocks);

/// The cells to exchange on a distributed level.
std::vector<LevelHalo::Peer> distributed_peers(const LatticeBlocks& blocks,
                                               const std::vector<BlockNeighbors>& neighbors,
                                               int level, const LevelGrid& grid);

/// The copies through periodic sides on a level that every rank holds whole.
std::vector<LevelHalo::Peer> periodic_peers(const LatticeBlocks& blocks, const LevelGrid& grid);

}  // namespace lockstep
