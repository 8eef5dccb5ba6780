#include "multigrid/block_neighbors.hpp"

#include <Tpetra_Map.hpp>
#include <algorithm>
#include <map>

namespace lockstep {

namespace {

constexpr int message_tag = 4712;

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

struct CellBox {
  Cell begin{}, end{1, 1, 1};
};

template <typename Function>
void for_each_cell_of(const CellBox& box, const Function& f) {
  for (int k = box.begin[2]; k < box.end[2]; ++k)
    for (int j = box.begin[1]; j < box.end[1]; ++j)
      for (int i = box.begin[0]; i < box.end[0]; ++i)
        f(i, j, k);
}

/// The block moved by whole periods into the lattice; false beyond another side.
bool wrap(const LatticeBlocks& blocks, Cell& begin) {
  for (int axis = 0; axis < blocks.dimension; ++axis) {
    const int n = blocks.n_cells[axis];
    if (blocks.periodic[axis])
      begin[axis] = (begin[axis] % n + n) % n;
    else if (begin[axis] < 0 || begin[axis] >= n)
      return false;
  }
  return true;
}

int n_cells_along(const LatticeBlocks& blocks, int axis, int level) {
  return axis < blocks.dimension ? (blocks.n_cells[axis] + (1 << level) - 1) >> level : 1;
}

/// The cells of a block on a level, in coordinates of the lattice.
CellBox box_of(const LatticeBlocks& blocks, const Cell& begin, int level) {
  CellBox box;
  for (int axis = 0; axis < blocks.dimension; ++axis) {
    box.begin[axis] = begin[axis] >> level;
    box.end[axis] = box.begin[axis] + (blocks.width >> level);
    if (!blocks.periodic[axis])
      box.end[axis] = std::min(box.end[axis], n_cells_along(blocks, axis, level));
  }
  return box;
}

void mark(const LevelGrid& grid, const CellBox& box, std::vector<char>& marks) {
  for (int k = box.begin[2]; k < box.end[2]; ++k)
    for (int j = box.begin[1]; j < box.end[1]; ++j)
      std::fill(marks.data() + grid.natural(box.begin[0], j, k),
                marks.data() + grid.natural(box.end[0], j, k), 1);
}

/// Natural array of 1 for cells within reach of this rank's.
std::vector<char> mark_reach(const LatticeBlocks& blocks, int level, const GhostReach& reach,
                             const LevelGrid& grid) {
  std::vector<char> marks(grid.n_natural, 0);
  for (const Cell& begin : blocks.begins) {
    if (!holds_cells(blocks, begin))
      continue;
    CellBox own = box_of(blocks, begin, level);
    for (int axis = 0; axis < blocks.dimension; ++axis) {
      own.begin[axis] -= grid.begin[axis];
      own.end[axis] = std::min(own.end[axis] - grid.begin[axis], grid.n[axis]);
    }
    CellBox box = own;
    for (int axis = 0; axis < blocks.dimension; ++axis) {
      if (!reach.around_corners)
        box = own;
      box.begin[axis] = std::max(own.begin[axis] - reach.depth, 0);
      box.end[axis] = std::min(own.end[axis] + reach.depth, grid.n[axis]);
      if (!reach.around_corners)
        mark(grid, box, marks);
    }
    mark(grid, box, marks);
  }
  return marks;
}

/// Ghosts by their owner, and the lexicographic numbers in the level's lattice of what they copy.
struct Wanted {
  std::map<int, LevelHalo::Peer> peers;
  std::map<int, std::vector<GlobalIndex>> numbers;
};

Wanted find_ghosts(const LatticeBlocks& blocks, const std::vector<NearBlock>& near_blocks,
                   int level, const GhostReach& reach, const LevelGrid& grid) {
  const std::vector<char> marks = mark_reach(blocks, level, reach, grid);
  Wanted wanted;
  for (const NearBlock& block : near_blocks) {
    Cell original = block.begin;
    wrap(blocks, original);
    CellBox box = box_of(blocks, block.begin, level);
    Cell shift{};
    for (int axis = 0; axis < blocks.dimension; ++axis) {
      shift[axis] = (original[axis] - block.begin[axis]) >> level;
      box.begin[axis] = std::max(box.begin[axis], grid.begin[axis]);
      box.end[axis] = std::min(box.end[axis], grid.begin[axis] + grid.n[axis]);
    }
    LevelHalo::Peer& peer = wanted.peers[block.rank];
    std::vector<GlobalIndex>& numbers = wanted.numbers[block.rank];
    peer.rank = block.rank;
    for_each_cell_of(box, [&](int i, int j, int k) {
      const LevelHalo::Cell cell = local_cell(grid, {i, j, k});
      if (!marks[cell.natural])
        return;
      peer.ghosts.push_back(cell);
      const GlobalIndex plane = k + shift[2];
      const GlobalIndex row = plane * n_cells_along(blocks, 1, level) + j + shift[1];
      numbers.push_back(row * n_cells_along(blocks, 0, level) + i + shift[0]);
    });
  }
  return wanted;
}

/// Tells each rank the cells that this one wants of it. Ghosts are mutual, so that each rank asks
/// exactly those that ask it.
std::map<int, std::vector<GlobalIndex>> ask(const Communicator& comm,
                                            std::map<int, std::vector<GlobalIndex>>& wanted) {
  const MPI_Comm mpi = raw_communicator(comm);
  std::map<int, std::vector<GlobalIndex>> asked;
  std::vector<MPI_Request> requests;
  for (auto& [rank, numbers] : wanted)
    MPI_Isend(numbers.data(), static_cast<int>(numbers.size()), MPI_LONG_LONG, rank, message_tag,
              mpi, &requests.emplace_back());
  for (const auto& [rank, numbers] : wanted) {
    MPI_Status status;
    int n = 0;
    MPI_Probe(rank, message_tag, mpi, &status);
    MPI_Get_count(&status, MPI_LONG_LONG, &n);
    asked[rank].resize(n);
    MPI_Recv(asked[rank].data(), n, MPI_LONG_LONG, rank, message_tag, mpi, MPI_STATUS_IGNORE);
  }
  MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
  return asked;
}

/// With all that are `reach` or less away along an axis, in steps of `width`. Sorted.
std::vector<Cell> spread(const std::vector<Cell>& begins, int axis, int reach, int width) {
  std::vector<Cell> result;
  result.reserve(begins.size() * (2 * reach / width + 1));
  for (Cell begin : begins) {
    begin[axis] -= reach;
    for (const int end = begin[axis] + 2 * reach; begin[axis] <= end; begin[axis] += width)
      result.push_back(begin);
  }
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

}  // namespace

LevelHalo::Cell local_cell(const LevelGrid& grid, const Cell& cell) {
  const int i = cell[0] - grid.begin[0], j = cell[1] - grid.begin[1], k = cell[2] - grid.begin[2];
  return {grid.natural(i, j, k), grid.slot_of_cell(i, j, k), LevelGrid::colour(i, j, k)};
}

void for_each_within_reach(const LatticeBlocks& blocks, int level, const GhostReach& reach,
                           const LevelGrid& grid, const std::function<void(const Cell&)>& visit) {
  const std::vector<char> marks = mark_reach(blocks, level, reach, grid);
  CellBox box{grid.begin, {}};
  for (int axis = 0; axis < 3; ++axis)
    box.end[axis] = grid.begin[axis] + grid.n[axis];
  for_each_cell_of(box, [&](int i, int j, int k) {
    if (marks[local_cell(grid, {i, j, k}).natural])
      visit({i, j, k});
  });
}

bool holds_cells(const LatticeBlocks& blocks, const Cell& begin) {
  for (int axis = 0; axis < blocks.dimension; ++axis) {
    if (begin[axis] >= blocks.n_cells[axis])
      return false;
  }
  return true;
}

std::vector<NearBlock> find_near_blocks(const LatticeBlocks& blocks, int reach) {
  std::vector<Cell> mine;
  for (const Cell& begin : blocks.begins) {
    if (holds_cells(blocks, begin))
      mine.push_back(begin);
  }
  std::sort(mine.begin(), mine.end());
  std::vector<Cell> around = mine;
  for (int axis = 0; axis < blocks.dimension; ++axis)
    around = spread(around, axis, reach * blocks.width, blocks.width);
  std::vector<Cell> found;
  for (const Cell& begin : around) {
    Cell original = begin;
    if (wrap(blocks, original) && !std::binary_search(mine.begin(), mine.end(), begin))
      found.push_back(begin);
  }
  std::vector<GlobalIndex> numbers;
  for (Cell begin : found) {
    wrap(blocks, begin);
    numbers.push_back(block_number(blocks, begin));
  }
  const auto owners = owners_of(blocks, numbers);
  std::vector<NearBlock> result;
  std::size_t next = 0;
  for (const Cell& begin : found) {
    const int rank = owners.at(numbers[next++]);
    if (rank >= 0)
      result.push_back({begin, rank});
  }
  return result;
}

std::vector<LevelHalo::Peer> distributed_peers(const LatticeBlocks& blocks,
                                               const std::vector<NearBlock>& near_blocks, int level,
                                               const GhostReach& reach, const LevelGrid& grid) {
  Wanted wanted = find_ghosts(blocks, near_blocks, level, reach, grid);
  const auto asked = ask(blocks.comm, wanted.numbers);
  const int n_x = n_cells_along(blocks, 0, level), n_y = n_cells_along(blocks, 1, level);
  std::vector<LevelHalo::Peer> peers;
  for (auto& [rank, peer] : wanted.peers) {
    for (const GlobalIndex number : asked.at(rank))
      peer.owned.push_back(
          local_cell(grid, {static_cast<int>(number % n_x), static_cast<int>(number / n_x % n_y),
                            static_cast<int>(number / n_x / n_y)}));
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
            LevelHalo::Cell from = local_cell(grid, owned);
            LevelHalo::Cell to = local_cell(grid, ghost);
            if (grid.n[axis] % 2 != 0)  // only the coarsest level, where no colour is exchanged
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
