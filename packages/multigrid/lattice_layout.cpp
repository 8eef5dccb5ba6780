#include "multigrid/lattice_layout.hpp"

#include <algorithm>
#include <limits>

#include "base/errors.hpp"
#include "multigrid/gathered_blocks.hpp"

namespace lockstep {

namespace {

/// Levels up to this many cells have a dense inverse.
constexpr int coarsest_cells = 300;
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

int n_levels(const LatticeBlocks& blocks) {
  const int at_least = log2_of(blocks.width) + 1;
  int levels = at_least;
  while (product(LatticeLayout::n_cells(blocks, levels - 1)) > coarsest_cells &&
         !is_odd_periodic(blocks, LatticeLayout::n_cells(blocks, levels - 1)))
    ++levels;
  return levels;
}

/// The box around a rank's cells and those that are `depth` cells or less from them.
LevelGrid distributed_grid(const LatticeBlocks& blocks, int level, int depth) {
  const auto whole = LatticeLayout::n_cells(blocks, level);
  LevelGrid grid;
  grid.dimension = blocks.dimension;
  grid.is_distributed = true;
  grid.n = whole;
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
    // Boxes begin at even cells.
    int begin = ((lowest >> level) - depth) & ~1, end = (highest >> level) + ((depth + 1) & ~1);
    if (!blocks.periodic[axis]) {
      begin = std::max(begin, 0);
      end = std::min(end, whole[axis]);
    }
    grid.begin[axis] = begin;
    grid.n[axis] = end - begin;
  }
  grid.set_strides(true);
  return grid;
}

LevelGrid replicated_grid(const LatticeBlocks& blocks, int level) {
  LevelGrid grid;
  grid.dimension = blocks.dimension;
  grid.n = LatticeLayout::n_cells(blocks, level);
  grid.set_strides(blocks.periodic[0]);
  return grid;
}

void mark_owned(const LatticeBlocks& blocks, int level, LayoutLevel& result) {
  const LevelGrid& grid = result.grid;
  result.owned.assign(grid.n_natural, 0);
  for (const auto& block : blocks.begins) {
    if (!holds_cells(blocks, block))
      continue;
    std::array<int, 3> low{}, high{1, 1, 1};
    for (int axis = 0; axis < grid.dimension; ++axis) {
      low[axis] = (block[axis] >> level) - grid.begin[axis];
      high[axis] = std::min(low[axis] + (blocks.width >> level), grid.n[axis]);
    }
    for (int k = low[2]; k < high[2]; ++k)
      for (int j = low[1]; j < high[1]; ++j)
        for (int i = low[0]; i < high[0]; ++i)
          result.owned[grid.natural(i, j, k)] = 1;
  }
}

}  // namespace

int log2_of(int width) {
  int log = 0;
  while ((1 << log) < width)
    ++log;
  return log;
}

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

LatticeLayout::LatticeLayout(std::shared_ptr<const LatticeBlocks> blocks,
                             const LayoutOptions& options)
    : options_(options), blocks_(std::move(blocks)) {
  const std::string reason = why_not(*blocks_);
  check_solve(reason.empty(), "{}", reason);
  const int n = n_levels(*blocks_);
  levels_.resize(n);
  Stage stage{blocks_, 0, 1, {}};
  bool is_distributed = blocks_->comm->getSize() > 1;
  if (is_distributed)
    stage.near_blocks = find_near_blocks(*blocks_, (options_.depth + 1) / 2);
  for (int level = 0; level < n; ++level) {
    const bool ends_stage = level - stage.first == log2_of(stage.blocks->width);
    if (level > 0)
      is_distributed = is_distributed && level + 1 < n &&
                       product(n_cells(*blocks_, level)) > options_.most_replicated_cells &&
                       (!ends_stage || can_gather(*stage.blocks));
    if (is_distributed && ends_stage)
      gather(level, stage);
    else if (is_distributed)
      distribute(stage, level);
    else
      replicate(level);
    levels_[level].find_parts();
  }
}

void LatticeLayout::replicate(int level) {
  LayoutLevel& result = levels_[level];
  result.grid = replicated_grid(*blocks_, level);
  result.halo = LevelHalo(blocks_->comm, periodic_peers(*blocks_, result.grid));
}

void LatticeLayout::distribute(const Stage& stage, int level) {
  const int in_stage = level - stage.first;
  LayoutLevel& result = levels_[level];
  result.grid = distributed_grid(*stage.blocks, in_stage, options_.depth);
  const auto halo = [&](const GhostReach& reach) {
    return LevelHalo(blocks_->comm, distributed_peers(*stage.blocks, stage.near_blocks, in_stage,
                                                      reach, result.grid));
  };
  result.halo = halo({1, false});
  result.deep_halo = halo({options_.depth, true});
  mark_owned(*stage.blocks, in_stage, result);
}

void LatticeLayout::gather(int level, Stage& stage) {
  const auto finer = stage.blocks;
  const int in_finer = level - stage.first;
  const auto gathered = gather_blocks(*finer, stage.rank_stride * options_.gathered_ranks);
  auto landing = std::make_unique<LayoutLevel>();
  landing->grid = distributed_grid(*finer, in_finer, 1);
  mark_owned(*finer, in_finer, *landing);
  stage = {gathered.blocks, level, gathered.rank_stride,
           find_near_blocks(*gathered.blocks, (options_.depth + 1) / 2)};
  distribute(stage, level);
  landing->halo =
      LevelHalo(blocks_->comm, landing_peers(*finer, landing->grid, gathered, levels_[level].grid));
  levels_[level].landing = std::move(landing);
}

}  // namespace lockstep
