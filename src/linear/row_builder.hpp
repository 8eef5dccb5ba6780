#pragma once
#include <memory>
#include <unordered_map>
#include <vector>

#include "linear/types.hpp"

namespace lockstep {

/// Assembles a distributed matrix row by row in O(entries), straight into the arrays that the
/// matrix keeps: this rank's rows in the order of the map, their entries in any order, though
/// nearly ascending columns are fastest. Entries of one column are summed up, in the order in which
/// they come. Inserting entries into a Tpetra matrix by their ids looks each of them up.
class RowBuilder {
 public:
  /// Rows and columns of the same map.
  explicit RowBuilder(const RCP<const Map>& map, int entries_per_row = 0);
  /// Vectors on `domain` go in, those on `rows` come out.
  RowBuilder(const RCP<const Map>& rows, const RCP<const Map>& domain, int entries_per_row = 0);
  ~RowBuilder();

  void reserve(std::size_t n_entries);
  /// A column as this builder knows it, for `add_at`: wherever many entries share it.
  int column(GlobalIndex id);
  /// Adds an entry to the present row; returns its place for `set`.
  std::size_t add(GlobalIndex id, double value) { return add_at(column(id), value); }
  std::size_t add_at(int column, double value);
  /// Changes the value of an entry of the present row.
  void set(std::size_t place, double value) { values_[place] = value; }
  void end_row();
  /// Collective, once, after as many rows as the map has here.
  RCP<CrsMatrix> finish();

 private:
  struct Arrays;
  /// Columns with a number before the matrix is finished; the others come in the order in which
  /// they were named.
  int n_numbered() const { return is_square_ ? n_own_ : 0; }
  int named(GlobalIndex id);
  void sort(std::size_t begin, std::size_t end);
  /// Numbers the columns in `named_`, own ones first, then those of other ranks by owner; returns
  /// the ids of all columns.
  std::vector<GlobalIndex> number_named();
  /// `named_` in that order, and how many of them are own.
  std::vector<std::pair<int, GlobalIndex>> by_owner() const;

  RCP<const Map> rows_, domain_;
  bool is_square_;
  bool is_contiguous_;  ///< ids of `domain_` follow one another, from rank to rank
  GlobalIndex first_ = 0;
  int n_rows_, n_own_;
  int row_ = 0;
  std::size_t size_ = 0;
  std::vector<GlobalIndex> named_;
  std::unordered_map<GlobalIndex, int> place_;  ///< in `named_`
  std::vector<std::pair<int, double>> scratch_;
  std::unique_ptr<Arrays> arrays_;
  std::size_t capacity_ = 0;
  int* columns_ = nullptr;  ///< into `arrays_`
  double* values_ = nullptr;
  std::size_t* starts_ = nullptr;
};

}  // namespace lockstep
