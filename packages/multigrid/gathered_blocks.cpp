#include "multigrid/gathered_blocks.hpp"

#include <Tpetra_Distributor.hpp>
#include <algorithm>
#include <map>

#include "multigrid/lattice_layout.hpp"

namespace lockstep {

namespace {

using Cell = std::array<int, 3>;

std::array<int, 3> coarsest_of(const LatticeBlocks& finer) {
  return LatticeLayout::n_cells(finer, log2_of(finer.width));
}

/// As wide as those of the finer level, unless a periodic axis is no multiple of that.
int gathered_width(const LatticeBlocks& finer) {
  const Cell n = coarsest_of(finer);
  int width = finer.width;
  for (int axis = 0; axis < finer.dimension; ++axis) {
    while (finer.periodic[axis] && n[axis] % width != 0)
      width /= 2;
  }
  return width;
}

Cell blocks_along(const LatticeBlocks& blocks) {
  Cell n{1, 1, 1};
  for (int axis = 0; axis < blocks.dimension; ++axis)
    n[axis] = (blocks.n_cells[axis] + blocks.width - 1) / blocks.width;
  return n;
}

}  // namespace

bool can_gather(const LatticeBlocks& finer) {
  return gathered_width(finer) > 1;
}

int GatheredBlocks::holder_of(const Cell& cell) const {
  const Cell n = blocks_along(*blocks);
  const long long n_holders = (blocks->comm->getSize() + rank_stride - 1) / rank_stride;
  const long long n_blocks = static_cast<long long>(n[0]) * n[1] * n[2];
  Cell at{};
  for (int axis = 0; axis < blocks->dimension; ++axis)
    at[axis] = cell[axis] / blocks->width;
  const long long number = at[0] + n[0] * (at[1] + static_cast<long long>(n[1]) * at[2]);
  return static_cast<int>(number * n_holders / n_blocks) * rank_stride;
}

GatheredBlocks gather_blocks(const LatticeBlocks& finer, int rank_stride) {
  LatticeBlocks blocks;
  blocks.dimension = finer.dimension;
  blocks.n_cells = coarsest_of(finer);
  blocks.periodic = finer.periodic;
  blocks.width = gathered_width(finer);
  blocks.comm = finer.comm;
  const GatheredBlocks all{std::make_shared<const LatticeBlocks>(blocks), rank_stride};
  const Cell n = blocks_along(blocks);
  for (int k = 0; k < n[2]; ++k)
    for (int j = 0; j < n[1]; ++j)
      for (int i = 0; i < n[0]; ++i) {
        const Cell begin{i * blocks.width, j * blocks.width,
                         blocks.dimension == 3 ? k * blocks.width : 0};
        if (all.holder_of(begin) == blocks.comm->getRank())
          blocks.begins.push_back(begin);
      }
  return {std::make_shared<const LatticeBlocks>(std::move(blocks)), rank_stride};
}

std::vector<LevelHalo::Peer> landing_peers(const LatticeBlocks& finer, const LevelGrid& landing,
                                           const GatheredBlocks& gathered, const LevelGrid& held) {
  const Cell n = gathered.blocks->n_cells;
  std::map<int, LevelHalo::Peer> peers;
  std::map<int, std::vector<GlobalIndex>> numbers;
  for_each_within_reach(finer, log2_of(finer.width), {1, false}, landing, [&](Cell cell) {
    const LevelHalo::Cell ghost = local_cell(landing, cell);
    for (int axis = 0; axis < finer.dimension; ++axis)
      cell[axis] = (cell[axis] % n[axis] + n[axis]) % n[axis];
    const int holder = gathered.holder_of(cell);
    peers[holder].ghosts.push_back(ghost);
    numbers[holder].push_back(cell[0] + n[0] * (cell[1] + GlobalIndex(n[1]) * cell[2]));
  });

  std::vector<int> holders;
  std::vector<GlobalIndex> told;
  for (const auto& [holder, of_holder] : numbers) {
    holders.insert(holders.end(), of_holder.size(), holder);
    told.insert(told.end(), of_holder.begin(), of_holder.end());
  }
  Tpetra::Distributor plan(finer.comm);
  std::vector<GlobalIndex> heard(
      plan.createFromSends({holders.data(), GlobalIndex(holders.size())}));
  plan.doPostsAndWaits(Teuchos::ArrayView<const GlobalIndex>(told.data(), told.size()), 1,
                       Teuchos::ArrayView<GlobalIndex>(heard.data(), heard.size()));
  const auto ranks = plan.getProcsFrom();
  const auto lengths = plan.getLengthsFrom();
  auto next = heard.begin();
  for (Teuchos_Ordinal i = 0; i < ranks.size(); ++i) {
    std::vector<LevelHalo::Cell>& owned = peers[ranks[i]].owned;
    for (const auto end = next + static_cast<std::ptrdiff_t>(lengths[i]); next != end; ++next)
      owned.push_back(
          local_cell(held, {static_cast<int>(*next % n[0]), static_cast<int>(*next / n[0] % n[1]),
                            static_cast<int>(*next / n[0] / n[1])}));
  }
  std::vector<LevelHalo::Peer> result;
  for (auto& [rank, peer] : peers) {
    peer.rank = rank;
    result.push_back(std::move(peer));
  }
  return result;
}

}  // namespace lockstep
