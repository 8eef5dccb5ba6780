#pragma once
#include <functional>
#include <string>
#include <vector>

#include "output/history.hpp"

namespace lockstep {

/// A column, and what it says of a row: one entry, so that the two cannot disagree.
/// `Row`: what a row is made from.
template <typename Row>
struct TableColumn : HistoryColumn {
  std::function<HistoryValue(const Row&)> value;
};

/// A table whose columns know their values.
template <typename Row>
class RowTable : public HistoryTable {
 public:
  RowTable(const Communicator& comm, const std::string& path,
           const std::vector<TableColumn<Row>>& columns)
      : HistoryTable(comm, path, {columns.begin(), columns.end()}), columns_(columns) {}

  /// Collective; the rows of rank 0 count.
  void append(const std::vector<Row>& rows) {
    std::vector<std::vector<HistoryValue>> values(rows.size());
    for (std::size_t r = 0; r < rows.size(); ++r)
      for (const TableColumn<Row>& column : columns_)
        values[r].push_back(column.value(rows[r]));
    append_rows(values);
  }
  /// A row by the names of its columns. Local.
  std::vector<std::pair<std::string, HistoryValue>> named(const Row& row) const {
    std::vector<std::pair<std::string, HistoryValue>> values;
    for (const TableColumn<Row>& column : columns_)
      values.emplace_back(column.name, column.value(row));
    return values;
  }

 private:
  std::vector<TableColumn<Row>> columns_;
};

}  // namespace lockstep
