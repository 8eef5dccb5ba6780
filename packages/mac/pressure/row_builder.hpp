#pragma once
#include <memory>
#include <vector>

#include "linear/types.hpp"

namespace lockstep {

/// Assembles a square distributed matrix row by row in O(entries), without hashing: rows arrive in
/// local order with the ids of a contiguous map, and only columns of other ranks are looked up.
/// Fastest when the columns of a row arrive nearly in ascending order.
class RowBuilder {
 public:
  /// No row may get more than `entries_per_row`.
  RowBuilder(const RCP<const Map>& map, int entries_per_row);
  ~RowBuilder();
  /// Adds an entry to the present row, each column once a row; returns its place for `set`.
  std::size_t add(GlobalIndex column, double value);
  /// Changes the value of an entry of the present row.
  void set(std::size_t place, double value);
  void end_row();
  /// Collective, once, after as many rows as the map has here.
  RCP<const CrsMatrix> finish();

 private:
  struct GhostEntry {
    std::size_t place;
    GlobalIndex column;
  };
  struct Arrays;
  void sort_rows();
  /// Gives ghost entries their local columns; returns the ghost ids, grouped by owner.
  std::vector<GlobalIndex> number_ghosts();

  RCP<const Map> map_;
  GlobalIndex first_;
  int n_rows_;
  int row_ = 0;
  std::size_t size_ = 0;
  std::vector<GhostEntry> ghosts_;
  std::unique_ptr<Arrays> arrays_;
  int* columns_;  ///< into `arrays_`
  double* values_;
  std::size_t* starts_;
};

}  // namespace lockstep
