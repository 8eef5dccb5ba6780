#pragma once
#include <functional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "base/communicator.hpp"
#include "base/errors.hpp"
#include "base/types.hpp"
#include "geometry/surface_snapshot.hpp"
#include "grid/tile_lattice.hpp"
#include "grid/tile_owners.hpp"

namespace lockstep {

/// A value for every stored cell, indexed by cell id.
using CellField = std::vector<double>;
/// A value for every stored face: the lower face of cell c normal to axis a is [a][c].
template <int dim>
using FaceField = std::array<CellField, dim>;

/// The cells of one tile along x, ids begin .. begin + n - 1, and what lies around them:
/// neighbors[0] and [1] are the single cells before the first and after the last; for the other
/// axes neighbors[2 * axis + side] is the first cell of the neighbouring row, whose ids run along
/// with the row's. -1 where there is nothing.
template <int dim>
struct CellStrip {
  int begin = 0, n = 0;
  std::array<int, 2 * dim> neighbors{};

  /// Calls f(cell, neighbours of the cell).
  template <typename Function>
  void for_each_cell(const Function& f) const;
};

/// A sparse Cartesian grid in tiles, distributed over the ranks. A rank stores whole tiles: first
/// those it owns, along the Morton curve, then ghost tiles (copies of other ranks' tiles within
/// reach), grouped by owner. The id of a cell is `tile * tile_volume + offset` (offset x fastest),
/// local to the rank.
///
/// The *lattice* is the domain and, on axes with `store_upper_face`, one more layer of cells above
/// it whose lower faces are the upper faces of the domain. A tile at the upper end may reach beyond
/// the lattice: the ids there are padding; they have storage, but no coordinate lookup or neighbour
/// leads to them. On periodic axes coordinates and neighbours wrap, and a tile of the rank's own
/// seen through the boundary is that tile itself, never a copy.
///
/// The grid knows of no fluid. It keeps O(stored tiles) data and a directory of the tiles in their
/// bounding box.
template <int dim>
class TiledGrid {
 public:
  /// Returns true if a tile, given its cells of the domain [begin, end), should exist. It is called
  /// on one rank only for each tile, so it must not communicate, and it must not depend on the
  /// rank.
  using TileChoice = std::function<bool(const Index<dim>& begin, const Index<dim>& end)>;
  /// The work of a tile, in that of a cell (default: its number of cells); same rules.
  using TileWeight = std::function<int(const Index<dim>& begin, const Index<dim>& end)>;

  /// Collective. Creates the tiles chosen (default all; a tile with extra layer cells only follows
  /// the tile below it) and divides them among the ranks by weight. Ghost tiles are those within
  /// `ghost_tiles` tile widths of an owned one. Throws InputError on all ranks on a bad
  /// description.
  TiledGrid(const GridDescription<dim>& description, const Communicator& comm,
            const TileChoice& tile_is_needed = {}, const TileWeight& weight = {},
            int ghost_tiles = 1);
  /// Makes a grid with tiles and ranks as given, the same list on all ranks.
  TiledGrid(const GridDescription<dim>& description, const Communicator& comm,
            const TileOwners& owners, int ghost_tiles = 1);
  /// Collective: a grid with the same owned tiles and cell ids, but ghost tiles within
  /// `ghost_tiles` tile widths. The ids of ghost cells differ.
  TiledGrid with_reach(int ghost_tiles) const;

  const GridDescription<dim>& description() const { return lattice_.description(); }
  const TileLattice<dim>& tile_lattice() const { return lattice_; }
  const Communicator& comm() const { return comm_; }
  double spacing() const { return description().spacing; }
  const Point<dim>& lower() const { return description().lower; }
  /// Cells of the domain along each axis.
  const Index<dim>& n_cells() const { return description().n_cells; }
  Lattice<dim> lattice() const { return {lower(), spacing()}; }

  /// True if every tile of the lattice exists, on some rank.
  bool is_complete() const { return is_complete_; }
  /// Cells [begin, end) of the domain that hold all tiles of all ranks.
  const std::array<Index<dim>, 2>& extent() const { return extent_; }
  /// True if the lattice goes on beside an owned tile, but no tile is there.
  bool ends_at(int tile, int axis, int side) const;
  /// Collective: which tiles of the domain exist, and who has them.
  TileOwners tile_owners() const;

  int n_owned_tiles() const { return n_owned_tiles_; }
  int n_tiles() const { return static_cast<int>(tiles_.size()); }
  /// Ids below this are owned; padding is counted.
  int n_owned_cells() const { return n_owned_tiles_ << log_tile_volume<dim>; }
  /// The size of a field.
  int n_stored_cells() const { return n_tiles() << log_tile_volume<dim>; }
  /// Every lattice cell within so many cells (maximum norm) of an owned one is stored, if its tile
  /// exists.
  int ghost_width() const { return ghost_tiles_ * tile_width<dim>; }

  static int tile_of(int cell) { return cell >> log_tile_volume<dim>; }
  /// Lattice coordinates of the first cell of a stored tile.
  const Index<dim>& tile_begin(int tile) const { return tiles_[tile].begin; }
  /// Cells of the tile, along each axis, that are in the domain.
  const Index<dim>& tile_domain_extent(int tile) const { return tiles_[tile].domain_extent; }
  /// Rank that owns a stored tile.
  int owner(int tile) const { return tiles_[tile].owner; }

  /// Lattice coordinates: 0 .. n-1 in the domain, n in an extra layer.
  Index<dim> coordinates(int cell) const;
  /// Id of a lattice cell, or -1 if it is not stored here or is outside the lattice. Periodic axes
  /// wrap.
  int cell(const Index<dim>& coordinates) const;
  /// The lattice cell below (side 0) or above (side 1) a lattice cell, or -1 if there is none here.
  int neighbor(int cell, int axis, int side) const;
  bool owned(int cell) const { return cell < n_owned_cells(); }
  bool in_domain(int cell) const;
  /// True if these coordinates, not wrapped, are in the domain; the tile need not exist.
  bool in_domain(const Index<dim>& coordinates) const;
  /// True for cells of the lattice, false for padding.
  bool in_lattice(int cell) const;
  /// Lexicographic number in the lattice: the same for any number of ranks and choice of tiles. Of
  /// lattice cells only.
  GlobalIndex global_id(int cell) const;
  /// The stored cell of that number, or -1.
  int cell_of_global_id(GlobalIndex id) const;

  Point<dim> center(int cell) const { return lattice().center(coordinates(cell)); }
  /// Centre of the lower face normal to `axis`.
  Point<dim> face_center(int axis, int cell) const;
  /// The point moved by whole periods into the domain (on other axes unchanged).
  Point<dim> wrap(const Point<dim>& x) const;
  /// The stored lattice cell that holds x (periodic axes wrap), or -1; also -1 if x is not a
  /// number.
  int cell_containing(const Point<dim>& x) const;

  /// Calls f(cell) for the owned cells of the domain, tile by tile, x fastest.
  template <typename Function>
  void for_each_owned_cell(const Function& f) const {
    for_each_cell_of_tiles(0, n_owned_tiles_, f);
  }
  /// Calls f for all stored cells of the domain, owned first.
  template <typename Function>
  void for_each_stored_cell(const Function& f) const {
    for_each_cell_of_tiles(0, n_tiles(), f);
  }
  /// Calls f(cell) for the owned faces of the domain normal to `axis`: lower faces of cells of the
  /// domain, and with `store_upper_face` of the layer above.
  template <typename Function>
  void for_each_owned_face(int axis, const Function& f) const;
  /// Calls f(first, n, below) for the rows of such faces along x, ids first .. first + n - 1;
  /// `below` is neighbor(first, axis, 0).
  template <typename Function>
  void for_each_owned_face_row(int axis, const Function& f) const;
  /// Calls f(row) for the rows of owned cells of the domain: the fastest way to apply a stencil.
  template <typename Function>
  void for_each_owned_strip(const Function& f) const;
  /// Calls f(cell, neighbors) for the owned cells of the domain; neighbors[2 * axis + side] is
  /// neighbor(cell, axis, side). Faster than asking for each.
  template <typename Function>
  void for_each_owned_cell_with_neighbors(const Function& f) const;

 private:
  struct Tile {
    Index<dim> begin{};                    ///< lattice coordinates of the first cell
    Index<dim> extent{};                   ///< cells in the lattice
    Index<dim> domain_extent{};            ///< cells in the domain
    std::array<int, 2 * dim> neighbors{};  ///< local tiles or -1
    int owner = 0;
  };
  static Index<dim> coordinates_of(const Tile& tile) {
    Index<dim> coordinates = tile.begin;
    for (int& c : coordinates)
      c /= tile_width<dim>;
    return coordinates;
  }
  static constexpr int log_width = log_tile_width<dim>;
  static constexpr int stride(int axis) { return 1 << (log_width * axis); }
  static constexpr int local(int cell, int axis) {
    return (cell >> (log_width * axis)) & (tile_width<dim> - 1);
  }

  TiledGrid(const TileLattice<dim>& lattice, const Communicator& comm)
      : lattice_(lattice), comm_(comm) {}
  /// Rank of every existing tile by tile number.
  using Owners = std::unordered_map<GlobalIndex, int>;
  Owners with_layers(const TileOwners& owners) const;
  void store_tiles(const Owners& owners, int ghost_tiles);
  void find_extent(const Owners& owners);
  void build_directory();
  void link_neighbors();
  /// `neighbor` of a lattice cell of that tile. Of rows, whose axis and side are constants, little
  /// is left once it is inlined.
  [[gnu::always_inline]] inline int neighbor_in_lattice(const Tile& tile, int cell, int axis,
                                                        int side) const;
  /// Local tile at these tile coordinates, or -1.
  int find_tile(const Index<dim>& tile) const;

  template <typename Function>
  static void for_each_offset(const Index<dim>& extent, const Function& f);
  template <typename Function>
  void for_each_cell_of_tiles(int begin, int end, const Function& f) const;

  TileLattice<dim> lattice_;
  Communicator comm_;
  int ghost_tiles_ = 1;
  int n_owned_tiles_ = 0;
  bool is_complete_ = true;
  std::array<Index<dim>, 2> extent_{};
  std::vector<Tile> tiles_;
  Index<dim> directory_lower_{}, directory_size_{};
  std::vector<int> directory_;  ///< local tile or -1 in the bounding box of the stored tiles
};

extern template class TiledGrid<2>;
extern template class TiledGrid<3>;

}  // namespace lockstep

#include "grid/tiled_grid_inline.hpp"
