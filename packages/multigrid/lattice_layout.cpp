#include "multigrid/lattice_layout.hpp"

#include <algorithm>
#include <limits>

#include "base/errors.hpp"
#include "multigrid/block_neighbors.hpp"

namespace lockstep {

namespace {

/// Levels up to this many cells have a dense inverse.
constexpr int coarsest_cells = 300;
/// So many cells every rank sweeps sooner than it hears from its neighbours.
constexpr int replicated_cells = 8000;
/// The most that a lattice may have left where a periodic axis cannot be halved again.
constexpr int most_coarsest_cells = 700;

bool is_odd_periodic(const LatticeBlocks& blocks, const std::array<int, 3>& n) {
  for (int axis = 0; axis < 3; ++axis) {
    if (blocks.periodic[axis] && n[axis] > 1 && n[axis] % 2 != 0)
      return true;
  }
  return false;
}

long long product(const std::array<int, 3>& n) {
  return static_cast<long long>(n[0]) * n[1] * n[2];
}

int log2_of(int width) {
  int log = 0;
  while ((1 << log) < width)
    ++log;
  return log;
}

/// Of several ranks. Levels with at most one cell a block are whole on every rank.
int n_distributed_levels(const LatticeBlocks& blocks) {
  int levels = 1;
  while (levels < log2_of(blocks.width) &&
         product(LatticeLayout::n_cells(blocks, levels)) > replicated_cells)
    ++levels;
  return levels;
}

int n_levels(const LatticeBlocks& blocks) {
  const int at_least = log2_of(blocks.width) + 1;
  int levels = at_least;
  while (product(LatticeLayout::n_cells(blocks, levels - 1)) > coarsest_cells &&
         !is_odd_periodic(blocks, LatticeLayout::n_cells(blocks, levels - 1)))
    ++levels;
  return levels;
}

}  // namespace

std::array<int, 3> LatticeLayout::n_cells(const LatticeBlocks& blocks, int level) {
  std::array<int, 3> n = blocks.n_cells;
  for (int axis = 0; axis < blocks.dimension; ++axis)
    n[axis] = (n[axis] + (1 << level) - 1) >> level;
  return n;
}

std::string LatticeLayout::why_not(const LatticeBlocks& blocks) {
  for (int axis = 0; axis < blocks.dimension; ++axis) {
    if (blocks.periodic[axis] && blocks.n_cells[axis] % blocks.width != 0)
      return fmt::format(
          "The multigrid needs a multiple of {} cells along a periodic axis, but axis {} has {}. "
          "Change the cells, or choose another \"Pressure Inverse\".",
          blocks.width, "xyz"[axis], blocks.n_cells[axis]);
  }
  const auto coarsest = n_cells(blocks, n_levels(blocks) - 1);
  if (product(coarsest) > most_coarsest_cells)
    return fmt::format(
        "The multigrid cannot halve the cells far enough: {} x {} x {} are left where a periodic "
        "axis becomes odd. Choose cells with more factors of 2, or another \"Pressure Inverse\".",
        coarsest[0], coarsest[1], coarsest[2]);
  return "";
}

void LayoutLevel::find_parts() {
  parts_.clear();
  parts_at_.assign(1, 0);
  for (int k = 0; k < grid.n[2]; ++k) {
    for (int j = 0; j < grid.n[1]; ++j) {
      if (owned.empty() && grid.n[0] > 0)
        parts_.push_back({0, grid.n[0]});
      const char* mine = owned.empty() ? nullptr : owned.data() + grid.natural(0, j, k);
      for (int i = 0; mine != nullptr && i < grid.n[0];) {
        const int begin = i;
        while (i < grid.n[0] && mine[i] == mine[begin])
          ++i;
        if (mine[begin])
          parts_.push_back({begin, i});
      }
      parts_at_.push_back(parts_.size());
    }
  }
}

LevelGrid LatticeLayout::make_grid(int level, bool is_distributed, int depth) const {
  const LatticeBlocks& blocks = *blocks_;
  const auto whole = n_cells(blocks, level);
  LevelGrid grid;
  grid.dimension = blocks.dimension;
  grid.is_distributed = is_distributed;
  grid.n = whole;
  if (is_distributed) {
    for (int axis = 0; axis < blocks.dimension; ++axis) {
      int lowest = std::numeric_limits<int>::max(), highest = 0;
      for (const auto& begin : blocks.begins) {
        if (!holds_cells(blocks, begin))
          continue;
        lowest = std::min(lowest, begin[axis]);
        highest = std::max(highest, begin[axis] + blocks.width);
      }
      if (highest == 0) {
        grid.n[axis] = 0;
        continue;
      }
      const int margin = (depth + 1) & ~1;  // boxes begin at even cells
      int begin = (lowest >> level) - margin, end = (highest >> level) + margin;
      if (!blocks.periodic[axis]) {
        begin = std::max(begin, 0);
        end = std::min(end, whole[axis]);
      }
      grid.begin[axis] = begin;
      grid.n[axis] = end - begin;
    }
  }
  grid.set_strides(is_distributed || blocks.periodic[0]);
  return grid;
}

LatticeLayout::LatticeLayout(std::shared_ptr<const LatticeBlocks> blocks, int depth)
    : blocks_(std::move(blocks)) {
  const std::string reason = why_not(*blocks_);
  check_solve(reason.empty(), "{}", reason);
  const bool several_ranks = blocks_->comm->getSize() > 1;
  const int n_distributed = several_ranks ? n_distributed_levels(*blocks_) : 0;
  const auto near_blocks =
      several_ranks ? find_near_blocks(*blocks_, (depth + 1) / 2) : std::vector<NearBlock>();
  levels_.resize(n_levels(*blocks_));
  for (int level = 0; level < static_cast<int>(levels_.size()); ++level) {
    LayoutLevel& result = levels_[level];
    result.grid = make_grid(level, level < n_distributed, depth);
    if (level < n_distributed) {
      const auto halo = [&](const GhostReach& reach) {
        return LevelHalo(blocks_->comm,
                         distributed_peers(*blocks_, near_blocks, level, reach, result.grid));
      };
      result.halo = halo({1, false});
      result.deep_halo = halo({depth, true});
      mark_owned(level);
    } else {
      result.halo = LevelHalo(blocks_->comm, periodic_peers(*blocks_, result.grid));
    }
    result.find_parts();
  }
}

void LatticeLayout::mark_owned(int level) {
  LayoutLevel& result = levels_[level];
  const LevelGrid& grid = result.grid;
  result.owned.assign(grid.n_natural, 0);
  for (const auto& block : blocks_->begins) {
    if (!holds_cells(*blocks_, block))
      continue;
    std::array<int, 3> low{}, high{1, 1, 1};
    for (int axis = 0; axis < grid.dimension; ++axis) {
      low[axis] = (block[axis] >> level) - grid.begin[axis];
      high[axis] = std::min(low[axis] + (blocks_->width >> level), grid.n[axis]);
    }
    for (int k = low[2]; k < high[2]; ++k)
      for (int j = low[1]; j < high[1]; ++j)
        for (int i = low[0]; i < high[0]; ++i)
          result.owned[grid.natural(i, j, k)] = 1;
  }
}

}  // namespace lockstep
