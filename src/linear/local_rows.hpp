#pragma once
#include <vector>

#include "linear/types.hpp"

namespace lockstep {

/// The columns of a matrix whose rows and columns are those of `map`: this rank's own rows first,
/// in their order, then those of other ranks that it names.
class LocalColumns {
 public:
  /// `ids` are all that its rows have entries in; they may repeat. Collective.
  LocalColumns(const RCP<const Map>& map, const std::vector<GlobalIndex>& ids);

  int n() const { return static_cast<int>(columns_->getNodeNumElements()); }
  int local(GlobalIndex id) const { return columns_->getLocalElement(id); }
  const RCP<const Map>& map() const { return map_; }
  const RCP<const Map>& columns() const { return columns_; }
  const RCP<const Import>& import() const { return import_; }  ///< null on one rank

 private:
  RCP<const Map> map_, columns_;
  RCP<const Import> import_;
};

/// Entries of this rank's rows, one row after the other, by local column. Much cheaper than
/// inserting entries by their ids, which Tpetra looks up one by one.
class LocalRows {
 public:
  explicit LocalRows(const LocalColumns& columns) : columns_(columns), place_(columns.n(), -1) {}

  void reserve(std::size_t n_entries);
  /// Adds to the row that is being written; entries of one column are summed up.
  void add(int column, double value);
  void end_row();
  /// Once all rows are written. Collective.
  RCP<CrsMatrix> matrix();

 private:
  const LocalColumns& columns_;
  std::vector<std::ptrdiff_t> place_;  ///< by column: where its entry stands, if in this row
  std::vector<std::size_t> begins_{0};
  std::vector<int> indices_;
  std::vector<double> values_;
};

}  // namespace lockstep
