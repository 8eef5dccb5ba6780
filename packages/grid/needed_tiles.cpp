#include "grid/needed_tiles.hpp"

#include <cmath>

namespace lockstep {

namespace {

void make_unique(std::vector<GlobalIndex>& tiles) {
  std::sort(tiles.begin(), tiles.end());
  tiles.erase(std::unique(tiles.begin(), tiles.end()), tiles.end());
}

}  // namespace

template <int dim>
void NeededTiles<dim>::add(Index<dim> begin, Index<dim> end) {
  for (int a = 0; a < dim; ++a) {
    if (lattice_.description().periodic[a])
      continue;
    const int last = lattice_.description().n_cells[a] - 1;
    begin[a] = std::clamp(begin[a], 0, last);
    end[a] = std::clamp(end[a], begin[a] + 1, last + 1);
  }
  // Most things, as the simplices of a surface, are where the last one was.
  std::array<Index<dim>, 4> place;
  for (int a = 0; a < dim; ++a) {
    const bool wraps = lattice_.description().periodic[a];  // anywhere in a tile
    const auto tile = [&](int cell) { return wraps ? cell : cell >> log_tile_width<dim>; };
    place[0][a] = tile(begin[a] - reach_);
    place[1][a] = tile(end[a] - 1 + reach_);
    place[2][a] = tile(begin[a] - margin_);
    place[3][a] = tile(end[a] - 1 + margin_);
  }
  if (!in_reach_.empty() && place == last_place_)
    return;
  last_place_ = place;
  add_tiles(begin, end, reach_, in_reach_);
  add_tiles(begin, end, margin_, wanted_);
}

template <int dim>
void NeededTiles<dim>::add(const Box<dim>& box) {
  const GridDescription<dim>& grid = lattice_.description();
  Index<dim> begin{}, end{};
  for (int a = 0; a < dim; ++a) {
    // places far beyond the domain must fit an int
    const double far = 4.0 * grid.n_cells[a];
    const auto place = [&](double x) {
      return static_cast<int>(
          std::floor(std::clamp((x - grid.lower[a]) / grid.spacing, -far, far)));
    };
    begin[a] = place(box.min()[a]);
    end[a] = place(box.max()[a]) + 1;
  }
  add(begin, end);
}

template <int dim>
void NeededTiles<dim>::add_tiles(const Index<dim>& begin, const Index<dim>& end, int distance,
                                 std::vector<GlobalIndex>& tiles) const {
  std::array<std::vector<TileSegment>, dim> along;
  std::size_t n = 1;
  for (int a = 0; a < dim; ++a) {
    along[a] = lattice_.segments(a, begin[a] - distance, end[a] + distance);
    // Tiles of a layer above the domain follow those below them.
    if (along[a].back().tile >= lattice_.n_domain_tiles()[a])
      along[a].pop_back();
    n *= along[a].size();
  }
  if (tiles.size() + n > tiles.capacity()) {  // things are many, tiles few
    make_unique(tiles);
    tiles.reserve(2 * (tiles.size() + n));
  }
  for (std::size_t i = 0; i < n; ++i) {
    Index<dim> tile{};
    std::size_t rest = i;
    for (int a = 0; a < dim; ++a) {
      tile[a] = along[a][rest % along[a].size()].tile;
      rest /= along[a].size();
    }
    tiles.push_back(lattice_.tile_number(tile));
  }
}

template <int dim>
std::vector<GlobalIndex> NeededTiles<dim>::wanted_by_all(const Communicator& comm) {
  make_unique(wanted_);
  std::vector<GlobalIndex> tiles = gather_all(comm, wanted_);
  make_unique(tiles);
  if (tiles.empty())
    tiles.push_back(0);
  return tiles;
}

template <int dim>
std::vector<GlobalIndex> NeededTiles<dim>::weights(const std::vector<GlobalIndex>& tiles) const {
  std::vector<GlobalIndex> result;
  for (const GlobalIndex tile : tiles) {
    GlobalIndex n = 1;
    for (const int cells : lattice_.domain_extent(lattice_.tile_coordinates(tile)))
      n *= cells;
    result.push_back(n);
  }
  return result;
}

template <int dim>
TileOwners NeededTiles<dim>::first(const Communicator& comm) {
  const std::vector<GlobalIndex> tiles = wanted_by_all(comm);
  return share_tiles(lattice_, comm, tiles, weights(tiles));
}

template <int dim>
bool NeededTiles<dim>::lacks_any(const TileOwners& present) {
  make_unique(in_reach_);
  return !std::includes(present.tiles.begin(), present.tiles.end(), in_reach_.begin(),
                        in_reach_.end());
}

template <int dim>
bool NeededTiles<dim>::are_there(const Communicator& comm, const TileOwners& present) {
  return max_all(comm, lacks_any(present) ? 1.0 : 0.0) == 0;
}

template <int dim>
std::optional<TileOwners> NeededTiles<dim>::change(const Communicator& comm,
                                                   const TileOwners& present) {
  make_unique(wanted_);
  // One flag a tile, who wants it, and one more: a tile is missing.
  const std::size_t n = present.tiles.size();
  std::vector<char> flags(n + 1, 0);
  for (std::size_t i = 0; i < n; ++i)
    flags[i] = std::binary_search(wanted_.begin(), wanted_.end(), present.tiles[i]);
  flags[n] = lacks_any(present);
  max_over_ranks(comm, flags);
  const auto n_idle = static_cast<std::size_t>(std::count(flags.begin(), flags.end() - 1, 0));
  if (flags[n] == 0 && 4 * n_idle <= n)
    return {};
  const std::vector<GlobalIndex> tiles = wanted_by_all(comm);
  if (tiles == present.tiles)
    return {};
  return share_tiles_again(lattice_, comm, present, tiles, weights(tiles));
}

template class NeededTiles<2>;
template class NeededTiles<3>;

}  // namespace lockstep
