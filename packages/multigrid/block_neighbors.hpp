#pragma once
#include <functional>
#include <vector>

#include "linear/stencil_operator.hpp"
#include "multigrid/level_grid.hpp"
#include "multigrid/level_halo.hpp"

namespace lockstep {

/// A block of another rank near this rank's, or a copy of a block through periodic sides.
struct NearBlock {
  std::array<int, 3> begin{};  ///< lattice coordinates, beyond the lattice through periodic sides
  int rank = 0;                ///< its owner, maybe this one
};

/// Reach of a rank into the cells of others.
struct GhostReach {
  int depth = 1;
  /// Maximum norm, else beyond faces only.
  bool around_corners = false;
};

/// Where a cell, in coordinates of the level's lattice, stands in a rank's storage.
LevelHalo::Cell local_cell(const LevelGrid& grid, const std::array<int, 3>& cell);

/// Calls visit(coordinates in the level's lattice) for the cells of a rank's blocks and those of
/// `grid` within reach of them.
void for_each_within_reach(const LatticeBlocks& blocks, int level, const GhostReach& reach,
                           const LevelGrid& grid,
                           const std::function<void(const std::array<int, 3>&)>& visit);

/// Returns false for blocks wholly beyond the domain.
bool holds_cells(const LatticeBlocks& blocks, const std::array<int, 3>& begin);

/// Returns the blocks within `reach` blocks along every axis of a block of this rank. Collective.
std::vector<NearBlock> find_near_blocks(const LatticeBlocks& blocks, int reach);

/// The cells to exchange on a distributed level, each ghost once. Collective.
std::vector<LevelHalo::Peer> distributed_peers(const LatticeBlocks& blocks,
                                               const std::vector<NearBlock>& near_blocks, int level,
                                               const GhostReach& reach, const LevelGrid& grid);

/// The copies through periodic sides on a level that every rank holds whole.
std::vector<LevelHalo::Peer> periodic_peers(const LatticeBlocks& blocks, const LevelGrid& grid);

}  // namespace lockstep
