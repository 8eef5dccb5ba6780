#pragma once
#include <vector>

#include "grid/tile_lattice.hpp"

namespace lockstep {

/// Values of the cells of some of the stored tiles, as of those around a liquid's surface; all
/// other cells have one value.
template <int dim, typename Value = double>
class TileField {
 public:
  /// `has_values`: of stored tiles. All values begin as that elsewhere.
  TileField(const std::vector<char>& has_values, Value elsewhere) : slot_(has_values.size(), 0) {
    int n = 1;
    for (std::size_t tile = 0; tile < slot_.size(); ++tile)
      if (has_values[tile])
        slot_[tile] = n++ << log_tile_volume<dim>;
    values_.assign(static_cast<std::size_t>(n) << log_tile_volume<dim>, elsewhere);
  }

  bool has(int cell) const { return slot_[cell >> log_tile_volume<dim>] > 0; }
  Value operator[](int cell) const { return values_[place(cell)]; }
  /// Sets the value of a cell that has one.
  void set(int cell, Value value) { values_[place(cell)] = value; }

  /// Place of a cell's value in the array; a cell with a place below `tile_volume` has none. Places
  /// run along with the cells of a tile, and tile by tile.
  int place(int cell) const {
    return slot_[cell >> log_tile_volume<dim>] + (cell & (tile_volume<dim> - 1));
  }
  std::size_t n_stored_tiles() const { return slot_.size(); }
  int end() const { return static_cast<int>(values_.size()); }
  Value& at_place(int place) { return values_[place]; }
  const Value& at_place(int place) const { return values_[place]; }

 private:
  std::vector<int> slot_;      ///< place of the first cell of stored tiles
  std::vector<Value> values_;  ///< first a tile for all that have none
};

}  // namespace lockstep
