#include "grid/tile_owners.hpp"

#include <numeric>
#include <string>

#include "base/errors.hpp"

namespace lockstep {

namespace {

constexpr int nobody = -1;

int position(const std::vector<GlobalIndex>& tiles, GlobalIndex tile) {
  const auto found = std::lower_bound(tiles.begin(), tiles.end(), tile);
  return found != tiles.end() && *found == tile ? static_cast<int>(found - tiles.begin()) : -1;
}

std::vector<GlobalIndex> loads_of(const std::vector<int>& ranks,
                                  const std::vector<GlobalIndex>& weights, int n_ranks) {
  std::vector<GlobalIndex> loads(n_ranks, 0);
  for (std::size_t i = 0; i < ranks.size(); ++i)
    if (ranks[i] != nobody)
      loads[ranks[i]] += weights[i];
  return loads;
}

GlobalIndex largest(const std::vector<GlobalIndex>& loads) {
  return *std::max_element(loads.begin(), loads.end());
}

/// The rank that has most of the neighbours of a tile, the lowest of equals; nobody if none has.
template <int dim>
int rank_of_neighbors(const TileLattice<dim>& lattice, const TileOwners& owners, int i) {
  const Index<dim> tile = lattice.tile_coordinates(owners.tiles[i]);
  std::array<int, 2 * dim> found;
  int n = 0;
  for (int axis = 0; axis < dim; ++axis)
    for (int side = 0; side < 2; ++side) {
      const GlobalIndex beside = lattice.neighbor_tile(tile, axis, side);
      const int j = beside == no_index ? -1 : position(owners.tiles, beside);
      if (j >= 0 && owners.ranks[j] != nobody)
        found[n++] = owners.ranks[j];
    }
  int best = nobody;
  std::ptrdiff_t most = 0;
  for (int k = 0; k < n; ++k) {
    const auto times = std::count(found.begin(), found.begin() + n, found[k]);
    if (times > most || (times == most && found[k] < best)) {
      most = times;
      best = found[k];
    }
  }
  return best;
}

/// Gives new tiles to the ranks around them, front after front; one that stands alone goes to the
/// rank with least to do.
template <int dim>
void place_new_tiles(const TileLattice<dim>& lattice, const std::vector<GlobalIndex>& weights,
                     int n_ranks, TileOwners& owners) {
  std::vector<int> waiting;
  for (std::size_t i = 0; i < owners.tiles.size(); ++i)
    if (owners.ranks[i] == nobody)
      waiting.push_back(static_cast<int>(i));
  while (!waiting.empty()) {
    std::vector<int> front, places, behind;
    for (const int i : waiting) {
      const int rank = rank_of_neighbors(lattice, owners, i);
      if (rank == nobody) {
        behind.push_back(i);
        continue;
      }
      front.push_back(i);
      places.push_back(rank);
    }
    if (front.empty()) {
      const auto loads = loads_of(owners.ranks, weights, n_ranks);
      front.push_back(behind.front());
      places.push_back(
          static_cast<int>(std::min_element(loads.begin(), loads.end()) - loads.begin()));
      behind.erase(behind.begin());
    }
    for (std::size_t k = 0; k < front.size(); ++k)
      owners.ranks[front[k]] = places[k];
    waiting = std::move(behind);
  }
}

}  // namespace

template <int dim>
TileOwners share_tiles(const TileLattice<dim>& lattice, const Communicator& comm,
                       std::vector<GlobalIndex> tiles, const std::vector<GlobalIndex>& weights) {
  TileOwners owners{std::move(tiles), {}};
  owners.ranks.resize(owners.tiles.size());
  std::string failure;
  if (is_root(comm)) {
    try {
      owners.ranks = partition_tiles<dim>(lattice, owners.tiles, {weights, {}}, comm->getSize());
    } catch (const Failure& error) {
      failure = error.what();
    }
  }
  throw_on_all(comm, failure, static_cast<int>(ExitCode::bad_input));
  MPI_Bcast(owners.ranks.data(), static_cast<int>(owners.ranks.size()), MPI_INT, 0,
            raw_communicator(comm));
  return owners;
}

template <int dim>
TileOwners share_tiles_again(const TileLattice<dim>& lattice, const Communicator& comm,
                             const TileOwners& before, std::vector<GlobalIndex> tiles,
                             const std::vector<GlobalIndex>& weights) {
  const int n_ranks = comm->getSize();
  TileOwners owners{std::move(tiles), {}};
  owners.ranks.reserve(owners.tiles.size());
  for (const GlobalIndex tile : owners.tiles) {
    const int i = position(before.tiles, tile);
    owners.ranks.push_back(i < 0 ? nobody : before.ranks[i]);
  }
  place_new_tiles(lattice, weights, n_ranks, owners);
  const GlobalIndex load = largest(loads_of(owners.ranks, weights, n_ranks));
  const GlobalIndex total = std::accumulate(weights.begin(), weights.end(), GlobalIndex{0});
  if (10 * load * n_ranks <= 12 * total)
    return owners;
  TileOwners anew = share_tiles(lattice, comm, owners.tiles, weights);
  return largest(loads_of(anew.ranks, weights, n_ranks)) < load ? anew : owners;
}

template <int dim>
std::optional<TileOwners> share_better(const TileLattice<dim>& lattice, const Communicator& comm,
                                       const TileOwners& before, const TileWork& work) {
  constexpr double worth_moving = 0.93;
  const int n_ranks = comm->getSize();
  TileOwners after = before;
  if (is_root(comm)) {
    const auto cost = [&](const std::vector<int>& parts) {
      return partition_cost(lattice, before.tiles, work, parts, n_ranks);
    };
    try {  // the others wait for what the root finds: without a proposal all stays
      std::vector<int> ranks = partition_tiles(lattice, before.tiles, work, n_ranks);
      if (cost(ranks) < worth_moving * cost(before.ranks))
        after.ranks = std::move(ranks);
    } catch (const Failure&) {
    }
  }
  MPI_Bcast(after.ranks.data(), static_cast<int>(after.ranks.size()), MPI_INT, 0,
            raw_communicator(comm));
  if (after.ranks == before.ranks)
    return {};
  return after;
}

template std::optional<TileOwners> share_better(const TileLattice<2>&, const Communicator&,
                                                const TileOwners&, const TileWork&);
template std::optional<TileOwners> share_better(const TileLattice<3>&, const Communicator&,
                                                const TileOwners&, const TileWork&);
template TileOwners share_tiles(const TileLattice<2>&, const Communicator&,
                                std::vector<GlobalIndex>, const std::vector<GlobalIndex>&);
template TileOwners share_tiles(const TileLattice<3>&, const Communicator&,
                                std::vector<GlobalIndex>, const std::vector<GlobalIndex>&);
template TileOwners share_tiles_again(const TileLattice<2>&, const Communicator&, const TileOwners&,
                                      std::vector<GlobalIndex>, const std::vector<GlobalIndex>&);
template TileOwners share_tiles_again(const TileLattice<3>&, const Communicator&, const TileOwners&,
                                      std::vector<GlobalIndex>, const std::vector<GlobalIndex>&);

}  // namespace lockstep
