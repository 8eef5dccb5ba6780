#include "output/history.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "base/errors.hpp"
#include "output/atomic_file.hpp"
#include "output/csv_line.hpp"
#include "output/on_root.hpp"

namespace lockstep {

namespace {
std::string names_of(const std::vector<HistoryColumn>& columns) {
  std::string line;
  for (const HistoryColumn& column : columns) {
    line += (line.empty() ? "" : ",") + column.name;
  }
  return line;
}
}  // namespace

HistoryTable::HistoryTable(const Communicator& comm, const std::string& path,
                           const std::vector<HistoryColumn>& columns)
    : comm_(comm), path_(path), columns_(columns) {}

HistoryTable::~HistoryTable() {
  if (descriptor_ >= 0)
    close(descriptor_);
}

std::string HistoryTable::header() const {
  std::string text;
  for (const HistoryColumn& column : columns_) {
    text += fmt::format("# {} [{}]: {}\n", column.name, column.unit, column.description);
  }
  return text + names_of(columns_) + "\n";
}

void HistoryTable::start() {
  on_root(comm_, [&] {
    write_file_atomically(path_, header());
    open_for_appending();
  });
}

void HistoryTable::check_names(const std::string& line) const {
  check_input(line == names_of(columns_),
              "'{}' has other columns than this run would write: choose another --output.", path_);
}

void HistoryTable::check_columns() const {
  on_root(comm_, [&] {
    std::ifstream file(path_);
    for (std::string line; std::getline(file, line);) {
      if (line.empty() || line.front() == '#')
        continue;
      if (!file.eof())  // a line without an end is one that was torn
        check_names(line);
      return;
    }
  });
}

void HistoryTable::resume(long long step) {
  on_root(comm_, [&] {
    const bool exists = std::filesystem::exists(path_);
    write_file_atomically(path_,
                          header() + (exists ? kept_rows(read_whole_file(path_), step) : ""));
    open_for_appending();
  });
}

void HistoryTable::open_for_appending() {
  if (descriptor_ >= 0)
    close(descriptor_);
  descriptor_ = open(path_.c_str(), O_WRONLY | O_APPEND);
  check_output(descriptor_ >= 0, "Cannot write '{}': {}.", path_, std::strerror(errno));
}

std::string HistoryTable::kept_rows(const std::string& text, long long step) const {
  const auto is_step = [](const HistoryColumn& column) { return column.name == "step"; };
  const auto step_column = static_cast<std::size_t>(
      std::find_if(columns_.begin(), columns_.end(), is_step) - columns_.begin());
  LOCKSTEP_ASSERT(step_column < columns_.size());
  std::string kept;
  bool names_seen = false;
  // A line without an end is one that was torn.
  for (std::size_t begin = 0, end = text.find('\n'); end != std::string::npos;
       begin = end + 1, end = text.find('\n', begin)) {
    const std::string line = text.substr(begin, end - begin);
    if (line.empty() || line.front() == '#')
      continue;
    if (!names_seen) {
      check_names(line);
      names_seen = true;
      continue;
    }
    const std::vector<std::string> fields = csv_fields(line);
    if (fields.size() != columns_.size())
      continue;
    const std::string& field = fields[step_column];
    long long row_step = 0;
    const auto parsed = std::from_chars(field.data(), field.data() + field.size(), row_step);
    if (parsed.ec == std::errc() && row_step <= step)
      kept += line + "\n";
  }
  return kept;
}

std::string HistoryTable::format_row(const std::vector<HistoryValue>& values) const {
  check_output(values.size() == columns_.size(), "'{}': a row has {} values for {} columns.", path_,
               values.size(), columns_.size());
  std::string line;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i > 0)
      line += ',';
    if (const auto* number = std::get_if<double>(&values[i])) {
      check_output(std::isfinite(*number) || (std::isnan(*number) && columns_[i].may_be_unknown),
                   "'{}': column '{}' would become {}; the run is broken.", path_, columns_[i].name,
                   *number);
      line += fmt::format("{:.17g}", *number);
    } else if (const auto* integer = std::get_if<long long>(&values[i])) {
      line += fmt::format("{}", *integer);
    } else {
      const std::string& text = std::get<std::string>(values[i]);
      check_output(text.find_first_of("\r\n") == std::string::npos,
                   "'{}': column '{}' would hold a line break.", path_, columns_[i].name);
      line += csv_field(text);
    }
  }
  return line + "\n";
}

void HistoryTable::append_row(const std::vector<HistoryValue>& values) {
  append_rows({values});
}

void HistoryTable::append_rows(const std::vector<std::vector<HistoryValue>>& rows) {
  on_root(comm_, [&] {
    std::string text;
    for (const std::vector<HistoryValue>& row : rows) {
      text += format_row(row);
    }
    append_text(text);
  });
}

void HistoryTable::append_text(const std::string& text) {
  struct stat status {};
  check_output(fstat(descriptor_, &status) == 0 && status.st_nlink > 0,
               "'{}' was removed while the run wrote to it: leave the files of a run until it has "
               "ended, and restart from its last checkpoint.",
               path_);
  const off_t end = lseek(descriptor_, 0, SEEK_END);
  const int error = end < 0 ? errno : write_fully(descriptor_, text);
  if (error == 0)
    return;
  const bool cut = end >= 0 && ftruncate(descriptor_, end) == 0;
  throw OutputError(
      fmt::format("Cannot write '{}': {}.{} Free some space or choose another --output.", path_,
                  std::strerror(error), cut ? "" : " Its last row is incomplete."));
}

}  // namespace lockstep
