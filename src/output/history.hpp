#pragma once
#include <string>
#include <variant>
#include <vector>

#include "base/communicator.hpp"

namespace lockstep {

struct HistoryColumn {
  std::string name;
  std::string unit;  ///< "1" if it has none
  std::string description;
  bool may_be_unknown = false;  ///< "nan" where a plug-in does not tell
};

/// One entry of a row. Numbers are written with 17 significant digits.
using HistoryValue = std::variant<long long, double, std::string>;

/// A CSV table that grows during the run: a commented header with the units, one line of column
/// names, then rows. Every row is on disk as a whole before the call that writes it returns, so
/// that a killed run leaves whole rows. One of the columns is called "step".
///
/// All member functions are collective; rank 0 writes and its values count. They throw OutputError
/// (full disk, a number that is not finite and may not be unknown, with the name of the column).
class HistoryTable {
 public:
  HistoryTable(const Communicator& comm, const std::string& path,
               const std::vector<HistoryColumn>& columns);
  ~HistoryTable();
  HistoryTable(const HistoryTable&) = delete;
  HistoryTable& operator=(const HistoryTable&) = delete;

  /// Begins an empty table.
  void start();
  /// Throws InputError if there is a file with other columns; writes nothing.
  void check_columns() const;
  /// Continues a table: drops the rows later than `step`, and a last row that was torn. A missing
  /// file is begun. Throws InputError as `check_columns`.
  void resume(long long step);

  const std::vector<HistoryColumn>& columns() const { return columns_; }

  void append_row(const std::vector<HistoryValue>& values);
  /// Several rows at the price of one (a row a solid, for example); ranks other than 0 may pass
  /// none.
  void append_rows(const std::vector<std::vector<HistoryValue>>& rows);

 private:
  std::string header() const;
  std::string format_row(const std::vector<HistoryValue>& values) const;
  void check_names(const std::string& line) const;
  std::string kept_rows(const std::string& text, long long step) const;
  void append_text(const std::string& text);
  void open_for_appending();

  Communicator comm_;
  std::string path_;
  std::vector<HistoryColumn> columns_;
  int descriptor_ = -1;  // rank 0 only
};

}  // namespace lockstep
