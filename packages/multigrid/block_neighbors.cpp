#include "multigrid/block_neighbors.hpp"

#include <Tpetra_Map.hpp>
#include <algorithm>
#include <map>

namespace lockstep {

namespace {

using Cell = std::array<int, 3>;

int blocks_along(const LatticeBlocks& blocks, int axis) {
  return axis < blocks.dimension ? (blocks.n_cells[axis] + blocks.width - 1) / blocks.width : 1;
}

/// Lexicographic number of the block that begins there.
GlobalIndex block_number(const LatticeBlocks& blocks, const Cell& begin) {
  GlobalIndex number = 0;
  for (int axis = blocks.dimension - 1; axis >= 0; --axis)
    number = number * blocks_along(blocks, axis) + begin[axis] / blocks.width;
  return number;
}

/// Where the block beside `begin` begins, or false beyond a side that is not periodic.
bool find_beside(const LatticeBlocks& blocks, const Cell& begin, int axis, int side, Cell& beside,
                 bool& wraps) {
  beside = begin;
  beside[axis] += side == 0 ? -blocks.width : blocks.width;
  wraps = beside[axis] < 0 || beside[axis] >= blocks.n_cells[axis];
  if (!wraps)
    return true;
  if (!blocks.periodic[axis])
    return false;
  beside[axis] = side == 0 ? blocks.n_cells[axis] - blocks.width : 0;
  return true;
}

/// Ranks of blocks by number, -1 for blocks that nobody has.
std::map<GlobalIndex, int> owners_of(const LatticeBlocks& blocks, std::vector<GlobalIndex> wanted) {
  // Tpetra answers a repeated question once only.
  std::sort(wanted.begin(), wanted.end());
  wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
  std::vector<GlobalIndex> mine;
  for (const Cell& begin : blocks.begins) {
    if (holds_cells(blocks, begin))
      mine.push_back(block_number(blocks, begin));
  }
  const Map directory(Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid(),
                      Teuchos::ArrayView<const GlobalIndex>(mine.data(), mine.size()), 0,
                      blocks.comm);
  std::vector<int> ranks(wanted.size(), -1);
  directory.getRemoteIndexList(Teuchos::ArrayView<const GlobalIndex>(wanted.data(), wanted.size()),
                               Teuchos::ArrayView<int>(ranks.data(), ranks.size()));
  std::map<GlobalIndex, int> result;
  for (std::size_t i = 0; i < wanted.size(); ++i)
    result[wanted[i]] = ranks[i];
  return result;
}

bool comes_before(const BlockFace& a, const BlockFace& b) {
  return std::tie(a.begin, a.axis, a.side, a.beside) < std::tie(b.begin, b.axis, b.side, b.beside);
}

/// Calls f(i, j, k) for the level's cells of one side of a block that begins at `begin`, in level
/// coordinates; `depth` cells outward from the first layer.
template <typename Function>
void for_each_cell_of_face(const LatticeBlocks& blocks, const Cell& begin, int axis, int side,
                           int depth, int level, const Function& f) {
  Cell low{}, high{1, 1, 1};
  for (int a = 0; a < blocks.dimension; ++a) {
    const int n = (blocks.n_cells[a] + (1 << level) - 1) >> level;
    low[a] = begin[a] >> level;
    high[a] = std::min(low[a] + (blocks.width >> level), n);
  }
  const int layer = side == 0 ? low[axis] - depth : high[axis] - 1 + depth;
  low[axis] = layer;
  high[axis] = layer + 1;
  for (int k = low[2]; k < high[2]; ++k)
    for (int j = low[1]; j < high[1]; ++j)
      for (int i = low[0]; i < high[0]; ++i)
        f(i, j, k);
}

LevelHalo::Cell local_cell(const LevelGrid& grid, int i, int j, int k) {
  i -= grid.begin[0];
  j -= grid.begin[1];
  k -= grid.begin[2];
  return {grid.natural(i, j, k), grid.slot_of_cell(i, j, k), LevelGrid::colour(i, j, k)};
}

}  // namespace

bool holds_cells(const LatticeBlocks& blocks, const Cell& begin) {
  for (int axis = 0; axis < blocks.dimension; ++axis) {
    if (begin[axis] >= blocks.n_cells[axis])
      return false;
  }
  return true;
}

std::vector<BlockNeighbors> find_block_neighbors(const LatticeBlocks& blocks) {
  std::vector<BlockFace> candidates;
  std::vector<GlobalIndex> numbers;
  std::vector<bool> wrapped;
  for (const Cell& begin : blocks.begins) {
    if (!holds_cells(blocks, begin))
      continue;
    for (int axis = 0; axis < blocks.dimension; ++axis) {
      for (int side = 0; side < 2; ++side) {
        Cell beside{};
        bool wraps = false;
        if (!find_beside(blocks, begin, axis, side, beside, wraps))
          continue;
        candidates.push_back({begin, beside, axis, side});
        numbers.push_back(block_number(blocks, beside));
        wrapped.push_back(wraps);
      }
    }
  }
  const auto owners = owners_of(blocks, numbers);
  const int me = blocks.comm->getRank();
  std::map<int, BlockNeighbors> by_rank;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const int rank = owners.at(numbers[i]);
    if (rank < 0 || (rank == me && !wrapped[i]))
      continue;
    const BlockFace& mine = candidates[i];
    BlockNeighbors& neighbors = by_rank[rank];
    neighbors.rank = rank;
    neighbors.owned.push_back(mine);
    neighbors.ghosts.push_back({mine.beside, mine.begin, mine.axis, 1 - mine.side});
  }
  std::vector<BlockNeighbors> result;
  for (auto& [rank, neighbors] : by_rank) {
    std::sort(neighbors.owned.begin(), neighbors.owned.end(), comes_before);
    std::sort(neighbors.ghosts.begin(), neighbors.ghosts.end(), comes_before);
    result.push_back(std::move(neighbors));
  }
  return result;
}

std::vector<LevelHalo::Peer> distributed_peers(const LatticeBlocks& blocks,
                                               const std::vector<BlockNeighbors>& neighbors,
                                               int level, const LevelGrid& grid) {
  std::vector<LevelHalo::Peer> peers;
  for (const BlockNeighbors& neighbor : neighbors) {
    LevelHalo::Peer peer;
    peer.rank = neighbor.rank;
    for (const BlockFace& face : neighbor.owned) {
      for_each_cell_of_face(
          blocks, face.begin, face.axis, face.side, 0, level,
          [&](int i, int j, int k) { peer.owned.push_back(local_cell(grid, i, j, k)); });
    }
    for (const BlockFace& face : neighbor.ghosts) {
      for_each_cell_of_face(
          blocks, face.beside, face.axis, 1 - face.side, 1, level,
          [&](int i, int j, int k) { peer.ghosts.push_back(local_cell(grid, i, j, k)); });
    }
    peers.push_back(std::move(peer));
  }
  return peers;
}

std::vector<LevelHalo::Peer> periodic_peers(const LatticeBlocks& blocks, const LevelGrid& grid) {
  LevelHalo::Peer peer;
  peer.rank = blocks.comm->getRank();
  for (int axis = 0; axis < blocks.dimension; ++axis) {
    if (!blocks.periodic[axis])
      continue;
    Cell n = grid.n;
    n[axis] = 1;
    for (int side = 0; side < 2; ++side) {
      for (int k = 0; k < n[2]; ++k)
        for (int j = 0; j < n[1]; ++j)
          for (int i = 0; i < n[0]; ++i) {
            Cell owned{i, j, k}, ghost{i, j, k};
            owned[axis] = side == 0 ? 0 : grid.n[axis] - 1;
            ghost[axis] = side == 0 ? grid.n[axis] : -1;
            LevelHalo::Cell from = local_cell(grid, owned[0], owned[1], owned[2]);
            LevelHalo::Cell to = local_cell(grid, ghost[0], ghost[1], ghost[2]);
            if (grid.n[axis] % 2 != 0)  // only the coarsest level: no sweep runs there
              to.colour = from.colour;
            peer.owned.push_back(from);
            peer.ghosts.push_back(to);
          }
    }
  }
  if (peer.ghosts.empty())
    return {};
  return {peer};
}

}  // namespace lockstep
