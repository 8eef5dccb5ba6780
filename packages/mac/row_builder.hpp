#pragma once
#include <vector>

#include "linear/types.hpp"

namespace lockstep {

/// Assembles a square distributed matrix row by row in O(entries), without hashing: rows arrive in
/// local order with the ids of a contiguous map, and only columns of other ranks are looked up.
class RowBuilder {
 public:
  RowBuilder(const RCP<const Map>& map, int entries_per_row);
  /// Adds an entry to the present row. Each column once a row.
  void add(GlobalIndex column, double value);
  void end_row();
  /// Collective, once, after as many rows as the map has here.
  RCP<const CrsMatrix> finish();

 private:
  struct GhostEntry {
    std::size_t position;
    GlobalIndex column;
  };
  void sort_rows();

  RCP<const Map> map_;
  GlobalIndex first_;
  int n_rows_;
  int row_ = 0;
  std::vector<GhostEntry> ghosts_;
  Teuchos::ArrayRCP<std::size_t> starts_;
  std::vector<int> columns_;
  std::vector<double> values_;
};

}  // namespace lockstep
