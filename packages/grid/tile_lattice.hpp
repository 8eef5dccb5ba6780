#pragma once
#include <algorithm>
#include <array>
#include <vector>

#include "base/types.hpp"

namespace lockstep {

/// Cells along each axis of a tile: 16^2 cells in 2D, 8^3 in 3D. A power of two.
template <int dim>
constexpr int tile_width = dim == 2 ? 16 : 8;
template <int dim>
constexpr int log_tile_width = dim == 2 ? 4 : 3;
template <int dim>
constexpr int log_tile_volume = dim* log_tile_width<dim>;
template <int dim>
constexpr int tile_volume = 1 << log_tile_volume<dim>;

/// A Cartesian domain of cubic cells.
template <int dim>
struct GridDescription {
  Point<dim> lower = Point<dim>::Zero();  ///< lower corner [m]
  double spacing = 1;                     ///< h [m]
  Index<dim> n_cells{};                   ///< cells along each axis, at least 1
  std::array<bool, dim> periodic{};
  /// Store the faces of the upper side of the axis (open and inflow sides): the lattice then has
  /// one more layer of cells there, outside the domain. Not allowed on a periodic axis.
  std::array<bool, dim> store_upper_face{};
};

/// Throws InputError naming the axis and the value that cannot be.
template <int dim>
void check_grid_description(const GridDescription<dim>& description);

/// The part of one tile that a range of lattice coordinates covers along one axis.
struct TileSegment {
  int tile = 0;            ///< tile coordinate along the axis
  int begin = 0, end = 0;  ///< cells within the tile
};

/// The arithmetic of the lattice: the cells of the domain and the extra layers, cut into tiles.
/// Knows nothing of which tiles exist or who owns them. A tile has a number (lexicographic, x
/// fastest) that does not depend on the number of ranks.
template <int dim>
class TileLattice {
 public:
  explicit TileLattice(const GridDescription<dim>& description);

  const GridDescription<dim>& description() const { return description_; }
  /// Cells of the lattice along each axis: those of the domain and the extra layer.
  const Index<dim>& n_cells() const { return n_cells_; }
  const Index<dim>& n_tiles() const { return n_tiles_; }
  /// Tiles along each axis that hold cells of the domain.
  Index<dim> n_domain_tiles() const;

  GlobalIndex tile_number(const Index<dim>& tile) const;
  Index<dim> tile_coordinates(GlobalIndex tile_number) const;
  /// Number of the neighbour tile, periodic axes wrap; no_index beyond the lattice.
  GlobalIndex neighbor_tile(const Index<dim>& tile, int axis, int side) const;
  /// Cells of the tile, along each axis, that belong to the lattice.
  Index<dim> extent(const Index<dim>& tile) const { return clipped_extent(tile, n_cells_); }
  /// Cells of the tile, along each axis, that belong to the domain.
  Index<dim> domain_extent(const Index<dim>& tile) const {
    return clipped_extent(tile, description_.n_cells);
  }
  /// The tiles that the coordinates [begin, end) touch along an axis. Periodic axes wrap (each cell
  /// appears once), others are clipped to the lattice.
  std::vector<TileSegment> segments(int axis, int begin, int end) const;
  /// Numbers, ascending, of the tiles within `width` cells (in the maximum norm, periodic axes
  /// wrap) of any of the given ones, which are among them.
  std::vector<GlobalIndex> tiles_within(std::vector<GlobalIndex> tile_numbers, int width) const;
  /// Calls f(tile coordinates, begin, end) for the part of each tile within `width` cells of the
  /// given tile, which itself is among them.
  template <typename Function>
  void for_each_tile_within(const Index<dim>& tile, int width, const Function& f) const;

 private:
  Index<dim> clipped_extent(const Index<dim>& tile, const Index<dim>& n_cells) const;

  GridDescription<dim> description_;
  Index<dim> n_cells_{}, n_tiles_{};
};

/// Position of a tile on the Morton (Z) curve: near tiles have near codes. Coordinates below 2^20.
template <int dim>
GlobalIndex morton_code(const Index<dim>& tile);

template <int dim>
template <typename Function>
void TileLattice<dim>::for_each_tile_within(const Index<dim>& tile, int width,
                                            const Function& f) const {
  const Index<dim> size = extent(tile);
  std::array<std::vector<TileSegment>, dim> parts;
  int n_parts = 1;
  for (int a = 0; a < dim; ++a) {
    const int begin = tile[a] * tile_width<dim>;
    parts[a] = segments(a, begin - width, begin + size[a] + width);
    n_parts *= static_cast<int>(parts[a].size());
  }
  for (int i = 0; i < n_parts; ++i) {
    Index<dim> found{}, begin{}, end{};
    for (int a = 0, rest = i; a < dim; ++a) {
      const int n = static_cast<int>(parts[a].size());
      const TileSegment& part = parts[a][rest % n];
      rest /= n;
      found[a] = part.tile;
      begin[a] = part.begin;
      end[a] = part.end;
    }
    f(found, begin, end);
  }
}

}  // namespace lockstep
