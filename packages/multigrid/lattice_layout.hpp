#pragma once
#include <array>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "linear/stencil_operator.hpp"
#include "multigrid/block_neighbors.hpp"
#include "multigrid/level_grid.hpp"
#include "multigrid/level_halo.hpp"

namespace lockstep {

/// Calls visit(cell, lattice coordinates) for the cells of this rank's blocks, in their order.
template <typename Visit>
void for_each_cell(const LatticeBlocks& blocks, const Visit& visit) {
  const int depth = blocks.dimension == 3 ? blocks.width : 1;
  std::size_t cell = 0;
  for (const auto& begin : blocks.begins) {
    for (int k = 0; k < depth; ++k) {
      for (int j = 0; j < blocks.width; ++j) {
        for (int i = 0; i < blocks.width; ++i, ++cell)
          visit(cell, std::array<int, 3>{begin[0] + i, begin[1] + j, begin[2] + k});
      }
    }
  }
}

/// Logarithm to base 2 of a power of two.
int log2_of(int width);

/// One level's storage and exchange.
struct LayoutLevel {
  /// Cells [begin, end) of a row, local coordinates.
  struct Part {
    int begin = 0, end = 0;
  };

  LevelGrid grid;
  LevelHalo halo;  ///< to the next cells beyond this rank's
  /// On a distributed level: as far as half sweeps reach in one pass through memory.
  LevelHalo deep_halo;
  std::vector<char> owned;  ///< natural array of the box: this rank's cells; empty: all of them
  /// On a level that is gathered to fewer ranks than the next finer one: its cells as the finer
  /// level's ranks see them; `halo` leads to the ranks that hold them. Else null.
  std::unique_ptr<const LayoutLevel> landing;

  /// Returns this level as the next finer level's ranks see it.
  const LayoutLevel& as_landed() const { return landing ? *landing : *this; }

  /// The parts of row (j, k) that are this rank's cells. Those of a distributed level begin at even
  /// cells, and rows 2 j and 2 j + 1 have the same, if both exist; likewise planes.
  struct Parts {
    const Part *first, *last;
    const Part* begin() const { return first; }
    const Part* end() const { return last; }
    bool empty() const { return first == last; }
  };
  Parts parts(int j, int k) const {
    const std::size_t row = j + grid.n[1] * static_cast<std::size_t>(k);
    return {parts_.data() + parts_at_[row], parts_.data() + parts_at_[row + 1]};
  }
  /// Finds the parts of the rows; called when `grid` and `owned` are set.
  void find_parts();

 private:
  std::vector<Part> parts_;
  std::vector<std::size_t> parts_at_;  ///< by row, and one more
};

struct LayoutOptions {
  /// Depth of the ghosts on distributed levels, in cells (maximum norm).
  int depth = 1;
  /// Largest number of cells of a level that every rank sweeps whole: that takes less time than a
  /// message from its neighbours.
  int most_replicated_cells = 8000;
  /// Number of ranks of which one holds the gathered cells.
  int gathered_ranks = 8;
};

/// The levels of a multigrid on a lattice: each halves the cells along every axis. Levels whose
/// cells are smaller than the blocks are distributed like the blocks. One with a single cell a
/// block is gathered to every eighth rank, in blocks of its own, and so on from there. Small levels
/// but the finest every rank holds whole. The coarsest is small enough for a dense inverse. Depends
/// on the blocks only, not on what fills them. The same on any number of ranks.
class LatticeLayout {
 public:
  /// Throws SolveError if `why_not` has a reason. Collective.
  LatticeLayout(std::shared_ptr<const LatticeBlocks> blocks, const LayoutOptions& options);

  /// Returns the reason why no multigrid can be built on this lattice, as a sentence; empty if one
  /// can.
  static std::string why_not(const LatticeBlocks& blocks);

  const LatticeBlocks& blocks() const { return *blocks_; }
  const std::vector<LayoutLevel>& levels() const { return levels_; }
  const LevelGrid& finest() const { return levels_.front().grid; }
  /// Cells of the whole lattice on a level.
  static std::array<int, 3> n_cells(const LatticeBlocks& blocks, int level);

 private:
  /// Levels that are distributed alike: `first` is the finest.
  struct Stage {
    std::shared_ptr<const LatticeBlocks> blocks;
    int first = 0;
    int rank_stride = 1;  ///< stride of the ranks that hold blocks
    std::vector<NearBlock> near_blocks;
  };
  void replicate(int level);
  void distribute(const Stage& stage, int level);
  /// Begins another stage with `level`.
  void gather(int level, Stage& stage);

  LayoutOptions options_;

  std::shared_ptr<const LatticeBlocks> blocks_;
  std::vector<LayoutLevel> levels_;
};

}  // namespace lockstep
