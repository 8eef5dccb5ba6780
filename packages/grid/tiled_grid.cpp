#include "grid/tiled_grid.hpp"

#include <algorithm>
#include <limits>
#include <string>

namespace lockstep {
namespace {

/// The tiles that the caller wants, with their weights, on every rank; each rank asks for its
/// share.
template <int dim>
struct ChosenTiles {
  std::vector<GlobalIndex> numbers, weights;
};

template <int dim>
ChosenTiles<dim> choose_tiles(const TileLattice<dim>& lattice, const Communicator& comm,
                              const typename TiledGrid<dim>::TileChoice& tile_is_needed,
                              const typename TiledGrid<dim>::TileWeight& weight) {
  const Index<dim> n = lattice.n_domain_tiles();
  GlobalIndex n_candidates = 1;
  for (int a = 0; a < dim; ++a)
    n_candidates *= n[a];
  const GlobalIndex n_ranks = comm->getSize(), rank = comm->getRank();

  ChosenTiles<dim> mine;
  std::string failure;
  ExitCode failure_code = ExitCode::bad_input;
  try {
    for (GlobalIndex i = n_candidates * rank / n_ranks; i < n_candidates * (rank + 1) / n_ranks;
         ++i) {
      Index<dim> tile{}, begin{}, end{};
      GlobalIndex rest = i;
      int n_cells = 1;
      for (int a = 0; a < dim; ++a) {
        tile[a] = static_cast<int>(rest % n[a]);
        rest /= n[a];
        begin[a] = tile[a] * tile_width<dim>;
        end[a] = begin[a] + lattice.domain_extent(tile)[a];
        n_cells *= end[a] - begin[a];
      }
      if (tile_is_needed && !tile_is_needed(begin, end))
        continue;
      mine.numbers.push_back(lattice.tile_number(tile));
      mine.weights.push_back(weight ? weight(begin, end) : n_cells);
    }
  } catch (const Failure& error) {
    failure = error.what();
    failure_code = error.exit_code();
  }
  throw_on_all(comm, failure, static_cast<int>(failure_code));
  return {gather_all(comm, mine.numbers), gather_all(comm, mine.weights)};
}

/// Tiles of extra layer cells only, directly above `tile`.
template <int dim>
std::vector<GlobalIndex> layer_tiles_above(const TileLattice<dim>& lattice,
                                           const Index<dim>& tile) {
  const Index<dim> n_domain = lattice.n_domain_tiles();
  std::vector<GlobalIndex> found;
  for (int combination = 1; combination < (1 << dim); ++combination) {
    Index<dim> above = tile;
    bool exists = true;
    for (int a = 0; a < dim; ++a) {
      if ((combination >> a & 1) == 0)
        continue;
      exists = exists && tile[a] == n_domain[a] - 1 && n_domain[a] < lattice.n_tiles()[a];
      ++above[a];
    }
    if (exists)
      found.push_back(lattice.tile_number(above));
  }
  return found;
}

}  // namespace

template <int dim>
TiledGrid<dim>::TiledGrid(const GridDescription<dim>& description, const Communicator& comm,
                          const TileChoice& tile_is_needed, const TileWeight& weight,
                          int ghost_tiles)
    : TiledGrid(TileLattice<dim>(description), comm) {
  const ChosenTiles<dim> chosen = choose_tiles<dim>(lattice_, comm_, tile_is_needed, weight);
  store_tiles(with_layers(share_tiles(lattice_, comm_, chosen.numbers, chosen.weights)),
              ghost_tiles);
}

template <int dim>
TiledGrid<dim>::TiledGrid(const GridDescription<dim>& description, const Communicator& comm,
                          const TileOwners& owners, int ghost_tiles)
    : TiledGrid(TileLattice<dim>(description), comm) {
  store_tiles(with_layers(owners), ghost_tiles);
}

template <int dim>
TiledGrid<dim> TiledGrid<dim>::with_reach(int ghost_tiles) const {
  TiledGrid wide(lattice_, comm_);
  wide.store_tiles(with_layers(tile_owners()), ghost_tiles);
  return wide;
}

template <int dim>
TileOwners TiledGrid<dim>::tile_owners() const {
  std::vector<GlobalIndex> mine;
  for (int t = 0; t < n_owned_tiles_; ++t) {
    bool holds_cells = true;
    for (const int n : tiles_[t].domain_extent)
      holds_cells = holds_cells && n > 0;
    if (!holds_cells)
      continue;
    mine.push_back(lattice_.tile_number(coordinates_of(tiles_[t])));
    mine.push_back(comm_->getRank());
  }
  const std::vector<GlobalIndex> all = gather_all(comm_, mine);
  std::vector<std::pair<GlobalIndex, int>> pairs;
  for (std::size_t i = 0; i < all.size(); i += 2)
    pairs.emplace_back(all[i], static_cast<int>(all[i + 1]));
  std::sort(pairs.begin(), pairs.end());
  TileOwners owners;
  for (const auto& [tile, rank] : pairs) {
    owners.tiles.push_back(tile);
    owners.ranks.push_back(rank);
  }
  return owners;
}

template <int dim>
typename TiledGrid<dim>::Owners TiledGrid<dim>::with_layers(const TileOwners& owners) const {
  Owners result;
  result.reserve(owners.tiles.size());
  for (std::size_t i = 0; i < owners.tiles.size(); ++i) {
    result[owners.tiles[i]] = owners.ranks[i];
    const Index<dim> tile = lattice_.tile_coordinates(owners.tiles[i]);
    for (const GlobalIndex above : layer_tiles_above<dim>(lattice_, tile))
      result[above] = owners.ranks[i];
  }
  return result;
}

template <int dim>
void TiledGrid<dim>::find_extent(const Owners& owners) {
  GlobalIndex n_in_lattice = 1;
  for (const int n : lattice_.n_tiles())
    n_in_lattice *= n;
  is_complete_ = static_cast<GlobalIndex>(owners.size()) == n_in_lattice;
  extent_ = {n_cells(), Index<dim>{}};
  for (const auto& [number, owner] : owners) {
    const Index<dim> tile = lattice_.tile_coordinates(number);
    for (int a = 0; a < dim; ++a) {
      const int begin = tile[a] * tile_width<dim>;
      extent_[0][a] = std::min(extent_[0][a], begin);
      extent_[1][a] = std::max(extent_[1][a], std::min(begin + tile_width<dim>, n_cells()[a]));
    }
  }
}

template <int dim>
void TiledGrid<dim>::store_tiles(const Owners& owners, int ghost_tiles) {
  check_input(ghost_tiles >= 1 && ghost_tiles <= 64,
              "The grid was asked for {} layers of ghost tiles; give 1 to 64.", ghost_tiles);
  ghost_tiles_ = ghost_tiles;
  const int rank = comm_->getRank();
  const auto sort_along_curve = [this, &owners](std::vector<GlobalIndex>& numbers) {
    std::vector<std::array<GlobalIndex, 3>> keys;  // owner, place on the Morton curve, number
    keys.reserve(numbers.size());
    for (const GlobalIndex number : numbers)
      keys.push_back(
          {owners.at(number), morton_code<dim>(lattice_.tile_coordinates(number)), number});
    std::sort(keys.begin(), keys.end());
    for (std::size_t i = 0; i < keys.size(); ++i)
      numbers[i] = keys[i][2];
  };

  std::vector<GlobalIndex> numbers, ghosts;
  for (const auto& [number, owner] : owners)
    if (owner == rank)
      numbers.push_back(number);
  sort_along_curve(numbers);
  for (const GlobalIndex number : lattice_.tiles_within(numbers, ghost_width())) {
    const auto found = owners.find(number);
    if (found != owners.end() && found->second != rank)
      ghosts.push_back(number);
  }
  sort_along_curve(ghosts);

  n_owned_tiles_ = static_cast<int>(numbers.size());
  numbers.insert(numbers.end(), ghosts.begin(), ghosts.end());
  constexpr std::size_t limit =
      std::size_t{std::numeric_limits<int>::max()} >> log_tile_volume<dim>;
  throw_on_all(comm_,
               numbers.size() > limit
                   ? fmt::format("Rank {} would store {} grid tiles, more than {}; use more ranks.",
                                 rank, numbers.size(), limit)
                   : std::string(),
               static_cast<int>(ExitCode::bad_input));
  tiles_.reserve(numbers.size());
  for (const GlobalIndex number : numbers) {
    const Index<dim> tile = lattice_.tile_coordinates(number);
    Tile record;
    for (int a = 0; a < dim; ++a)
      record.begin[a] = tile[a] * tile_width<dim>;
    record.extent = lattice_.extent(tile);
    record.domain_extent = lattice_.domain_extent(tile);
    record.owner = owners.at(number);
    tiles_.push_back(record);
  }
  find_extent(owners);
  build_directory();
  link_neighbors();
}

template <int dim>
void TiledGrid<dim>::build_directory() {
  if (tiles_.empty())
    return;
  Index<dim> upper{};
  directory_lower_.fill(std::numeric_limits<int>::max());
  for (const Tile& tile : tiles_) {
    for (int a = 0; a < dim; ++a) {
      directory_lower_[a] = std::min(directory_lower_[a], tile.begin[a] / tile_width<dim>);
      upper[a] = std::max(upper[a], tile.begin[a] / tile_width<dim> + 1);
    }
  }
  std::size_t size = 1;
  for (int a = 0; a < dim; ++a) {
    directory_size_[a] = upper[a] - directory_lower_[a];
    size *= directory_size_[a];
  }
  directory_.assign(size, -1);
  for (int t = 0; t < n_tiles(); ++t) {
    std::size_t entry = 0;
    for (int a = dim - 1; a >= 0; --a)
      entry =
          entry * directory_size_[a] + tiles_[t].begin[a] / tile_width<dim> - directory_lower_[a];
    directory_[entry] = t;
  }
}

template <int dim>
void TiledGrid<dim>::link_neighbors() {
  for (Tile& tile : tiles_) {
    const Index<dim> here = coordinates_of(tile);
    for (int i = 0; i < 2 * dim; ++i) {
      const GlobalIndex number = lattice_.neighbor_tile(here, i / 2, i % 2);
      tile.neighbors[i] = number == no_index ? -1 : find_tile(lattice_.tile_coordinates(number));
    }
  }
}

template <int dim>
bool TiledGrid<dim>::ends_at(int tile, int axis, int side) const {
  return !is_complete_ && tiles_[tile].neighbors[2 * axis + side] < 0 &&
         lattice_.neighbor_tile(coordinates_of(tiles_[tile]), axis, side) != no_index;
}

template <int dim>
int TiledGrid<dim>::cell_of_global_id(GlobalIndex id) const {
  if (id < 0)
    return -1;
  Index<dim> c{};
  for (int a = 0; a < dim; ++a) {
    c[a] = static_cast<int>(id % lattice_.n_cells()[a]);
    id /= lattice_.n_cells()[a];
  }
  return id > 0 ? -1 : cell(c);
}

template class TiledGrid<2>;
template class TiledGrid<3>;

}  // namespace lockstep
