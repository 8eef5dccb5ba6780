#pragma once
#include <array>
#include <optional>
#include <vector>

#include "grid/tiled_grid.hpp"

namespace lockstep {

/// Finds out which tiles a grid should have, from where things are: its owner says where, on each
/// rank what that rank knows. A tile is *wanted* within `margin` cells of a thing. The tiles are
/// chosen anew if one is missing within `reach` cells of a thing, or more than a quarter of those
/// there are is not wanted; so they change seldom if the margin is wider than the reach.
template <int dim>
class NeededTiles {
 public:
  /// `reach`: distance that things may move in the next step; `margin`: distance around them in
  /// which tiles are made [cells], at least the reach.
  NeededTiles(const TileLattice<dim>& lattice, int reach, int margin)
      : lattice_(lattice), reach_(reach), margin_(std::max(reach, margin)) {}

  /// A thing in the cells [begin, end) of the lattice; periodic axes wrap, what is beyond the
  /// others counts for the cells at their ends. Local.
  void add(Index<dim> begin, Index<dim> end);
  /// Adds a thing in a box in space [m]. Local.
  void add(const Box<dim>& box);
  /// A thing in every owned cell of the domain for which is_there(cell), tile by tile: in the
  /// smallest box around them. Local.
  template <typename IsThere>
  void add_cells(const TiledGrid<dim>& grid, const IsThere& is_there);

  /// Collective: the tiles wanted, at least one, divided among the ranks by their cells.
  TileOwners first(const Communicator& comm);
  /// Collective, one reduction if all stays as it is: the tiles wanted and who should have them,
  /// where they have to change. `present`: those of the grid.
  std::optional<TileOwners> change(const Communicator& comm, const TileOwners& present);
  /// True if all tiles within reach exist. Collective.
  bool are_there(const Communicator& comm, const TileOwners& present);

 private:
  /// True if a tile within reach of this rank's things is missing. Local.
  bool lacks_any(const TileOwners& present);
  void add_tiles(const Index<dim>& begin, const Index<dim>& end, int distance,
                 std::vector<GlobalIndex>& tiles) const;
  std::vector<GlobalIndex> wanted_by_all(const Communicator& comm);
  std::vector<GlobalIndex> weights(const std::vector<GlobalIndex>& tiles) const;

  const TileLattice<dim>& lattice_;
  int reach_, margin_;
  std::vector<GlobalIndex> in_reach_, wanted_;
  std::array<Index<dim>, 4> last_place_{};  ///< tiles at the ends of the last thing, both ways
};

template <int dim>
template <typename IsThere>
void NeededTiles<dim>::add_cells(const TiledGrid<dim>& grid, const IsThere& is_there) {
  int tile = -1;
  Index<dim> begin{}, end{};
  grid.for_each_owned_cell([&](int cell) {
    if (!is_there(cell))
      return;
    const Index<dim> c = grid.coordinates(cell);
    const bool is_first = grid.tile_of(cell) != tile;
    if (is_first && tile >= 0)
      add(begin, end);
    tile = grid.tile_of(cell);
    for (int a = 0; a < dim; ++a) {
      begin[a] = is_first ? c[a] : std::min(begin[a], c[a]);
      end[a] = is_first ? c[a] + 1 : std::max(end[a], c[a] + 1);
    }
  });
  if (tile >= 0)
    add(begin, end);
}

}  // namespace lockstep
