#include "motion/timed_table.hpp"

#include <algorithm>

#include "base/errors.hpp"

namespace lockstep {

namespace {

/// Slopes at which the cubic between two points never leaves their interval (Fritsch and Butland).
std::vector<double> monotone_slopes(const std::vector<double>& x, const std::vector<double>& y) {
  const std::size_t n = x.size();
  std::vector<double> slopes(n, 0.0);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double before = x[i] - x[i - 1], after = x[i + 1] - x[i];
    const double left = (y[i] - y[i - 1]) / before, right = (y[i + 1] - y[i]) / after;
    if (left * right > 0) {
      const double a = 2 * after + before, b = after + 2 * before;
      slopes[i] = (a + b) / (a / left + b / right);
    }
  }
  slopes.front() = (y[1] - y[0]) / (x[1] - x[0]);
  slopes.back() = (y[n - 1] - y[n - 2]) / (x[n - 1] - x[n - 2]);
  return slopes;
}

}  // namespace

TimedColumn::TimedColumn(const std::vector<double>& times, const std::vector<double>& values)
    : first_(times.front()),
      last_(times.back()),
      curve_(std::vector<double>(times), std::vector<double>(values),
             monotone_slopes(times, values)) {}

double TimedColumn::value(double time) const {
  return curve_(std::clamp(time, first_, last_));
}

double TimedColumn::slope(double time) const {
  return time < first_ || time > last_ ? 0 : curve_.prime(time);
}

void declare_times(ParameterList& table) {
  declare_required<ParameterArray<double>>(table, "Times", "Ascending times [s], two or more.");
}

std::vector<double> read_times(const ParameterList& table, const std::string& where) {
  const std::vector<double> times = table.get<ParameterArray<double>>("Times").toVector();
  check_input(times.size() >= 2, "In \"{}\", \"Times\" needs two or more times.", where);
  for (std::size_t i = 1; i < times.size(); ++i)
    check_input(times[i] > times[i - 1], "In \"{}\", \"Times\" must ascend, but {} follows {}.",
                where, times[i], times[i - 1]);
  return times;
}

std::vector<TimedColumn> read_columns(const ParameterList& table, const std::string& name,
                                      const std::vector<double>& times, int n_components,
                                      const std::string& where) {
  std::vector<TimedColumn> columns;
  if (!table.isParameter(name))
    return columns;
  const auto& rows = table.get<ParameterArray<double>>(name);
  const std::size_t wanted = times.size() * static_cast<std::size_t>(n_components);
  check_input(static_cast<std::size_t>(rows.size()) == wanted,
              "In \"{}\", \"{}\" has {} numbers, but {} times need {}.", where, name, rows.size(),
              times.size(), wanted);
  for (int c = 0; c < n_components; ++c) {
    std::vector<double> values;
    for (std::size_t i = 0; i < times.size(); ++i)
      values.push_back(rows[i * n_components + c]);
    columns.emplace_back(times, values);
  }
  return columns;
}

}  // namespace lockstep
