#include "studies/measure.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/errors.hpp"
#include "studies/frame_field.hpp"
#include "studies/surface_rows.hpp"

namespace lockstep {

namespace {

/// Mean frequency of the rises through 0 [1/s].
double rise_frequency(const std::vector<double>& times, const std::vector<double>& values) {
  int n_rises = 0;
  double first = 0, last = 0;
  for (std::size_t i = 1; i < values.size(); ++i) {
    if (values[i - 1] >= 0 || values[i] < 0)
      continue;
    const double part = values[i - 1] / (values[i - 1] - values[i]);
    last = times[i - 1] + part * (times[i] - times[i - 1]);
    if (n_rises++ == 0)
      first = last;
  }
  check_input(n_rises > 1, "A frequency needs two rises through 0, but there are {}.", n_rises);
  return (n_rises - 1) / (last - first);
}

double reduce(Quantity::Over over, const std::vector<double>& times,
              const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  const auto [least, largest] = std::minmax_element(values.begin(), values.end());
  switch (over) {
    case Quantity::Over::last:
      return values.back();
    case Quantity::Over::first:
      return values.front();
    case Quantity::Over::max:
      return *largest;
    case Quantity::Over::min:
      return *least;
    case Quantity::Over::mean:
      return std::accumulate(values.begin(), values.end(), 0.0) / n;
    case Quantity::Over::rms:
      return std::sqrt(std::inner_product(values.begin(), values.end(), values.begin(), 0.0) / n);
    case Quantity::Over::amplitude:
      return 0.5 * (*largest - *least);
    case Quantity::Over::frequency:
      return rise_frequency(times, values);
  }
  return 0;
}

/// From the rows, each of which holds the same names, "time" among them.
double row_value(const Quantity& quantity, const std::vector<Variables>& rows,
                 const Variables& variables) {
  const std::string where = fmt::format("Quantity \"{}\"", quantity.name);
  // The columns come last: a row's own dt, not the mean one.
  Variables all = variables;
  for (const auto& [name, value] : rows.front())
    all[name] = value;
  const Expression expression(quantity.expression, all, where);
  std::vector<double> times, values;
  for (const Variables& row : rows) {
    if (row.at("time") < quantity.from_time)
      continue;
    for (const auto& [name, value] : row)
      all[name] = value;
    times.push_back(row.at("time"));
    values.push_back(expression.value());
  }
  check_input(!values.empty(), "{}: no row is later than \"Start\" = {} s.", where,
              quantity.from_time);
  return reduce(quantity.over, times, values);
}

double field_value(const Quantity& quantity, const RunResults& run, const Variables& variables) {
  const FrameField field = read_last_frame(run.directory, quantity.field);
  const std::string where = fmt::format("Quantity \"{}\"", quantity.name);
  const auto component = static_cast<std::size_t>(quantity.component);
  check_input(component < field.n_components, "{}: \"{}\" has no component {}.", where,
              quantity.field, quantity.component);
  Variables all = variables;
  all["t"] = field.time;
  std::array<double*, 3> x{&all["x"], &all["y"], &all["z"]};
  const auto set = [&](std::size_t axis, std::size_t cell) {
    *x[axis] = field.origin[axis] + (static_cast<double>(cell) + 0.5) * field.spacing[axis];
  };
  const Expression exact(quantity.expression, all, where);
  double sum = 0, squares = 0, largest = 0;
  std::size_t next = component;
  for (std::size_t k = 0; k < field.n_cells[2]; ++k) {
    set(2, k);
    for (std::size_t j = 0; j < field.n_cells[1]; ++j) {
      set(1, j);
      for (std::size_t i = 0; i < field.n_cells[0]; ++i, next += field.n_components) {
        set(0, i);
        const double error = std::abs(field.values[next] - exact.value());
        sum += error;
        squares += error * error;
        largest = std::max(largest, error);
      }
    }
  }
  const auto n = static_cast<double>(field.values.size() / field.n_components);
  if (quantity.norm == Quantity::Norm::max)
    return std::isnan(sum) ? sum : largest;
  return quantity.norm == Quantity::Norm::l1 ? sum / n : std::sqrt(squares / n);
}

/// The largest value along a line of cells, `sign` = -1: of the negative field.
double line_maximum(const Quantity& quantity, const FrameField& field, double sign) {
  const auto axis = static_cast<std::size_t>(quantity.axis);
  const std::array<std::size_t, 3> stride{field.n_components, field.n_components * field.n_cells[0],
                                          field.n_components * field.n_cells[0] * field.n_cells[1]};
  // Across the line, the two cells around it and the share of the upper one.
  std::size_t first = static_cast<std::size_t>(quantity.component);
  std::array<std::size_t, 3> step{};
  std::array<double, 3> share{};
  for (std::size_t a = 0; a < 3; ++a) {
    if (a == axis || field.n_cells[a] == 1)
      continue;
    const double place = std::clamp((quantity.point[a] - field.origin[a]) / field.spacing[a] - 0.5,
                                    0.0, static_cast<double>(field.n_cells[a]) - 1);
    const auto cell = std::min(static_cast<std::size_t>(place), field.n_cells[a] - 2);
    first += cell * stride[a];
    step[a] = stride[a];
    share[a] = place - static_cast<double>(cell);
  }
  std::vector<double> values(field.n_cells[axis], 0.0);
  for (std::size_t i = 0; i < values.size(); ++i) {
    for (std::size_t corner = 0; corner < 8; ++corner) {
      std::size_t at = first + i * stride[axis];
      double weight = sign;
      for (std::size_t a = 0; a < 3; ++a) {
        const bool upper = ((corner >> a) & 1) != 0;
        at += upper ? step[a] : 0;
        weight *= upper ? share[a] : 1 - share[a];
      }
      values[i] += weight == 0 ? 0 : weight * field.values[at];
    }
  }
  if (const double sum = std::accumulate(values.begin(), values.end(), 0.0); std::isnan(sum))
    return sum;
  const auto top = std::max_element(values.begin(), values.end());
  if (top == values.begin() || top + 1 == values.end())
    return *top;
  const double slope = 0.5 * (top[1] - top[-1]), bend = top[1] - 2 * top[0] + top[-1];
  return bend == 0 ? *top : *top - 0.5 * slope * slope / bend;
}

double line_value(const Quantity& quantity, const RunResults& run) {
  const FrameField field = read_last_frame(run.directory, quantity.field);
  check_input(static_cast<std::size_t>(quantity.component) < field.n_components,
              "Quantity \"{}\": \"{}\" has no component {}.", quantity.name, quantity.field,
              quantity.component);
  const double sign = quantity.over == Quantity::Over::max ? 1 : -1;
  return sign * line_maximum(quantity, field, sign);
}

}  // namespace

Variables run_variables(const Study& study, const StudyCase& study_case, const RunResults& run) {
  Variables variables = run.summary;
  for (const auto& [name, path] : study.parameters)
    variables[name] = scene_number(run.scene, path);
  variables["h"] = run.spacing;
  variables["dt"] = run.mean_step;
  variables["cells"] = run.n_cells;
  for (const auto& [name, value] : study_case.constants) {
    constexpr double rounded = 1e-3;  // as decimals of a study are
    check_input(
        name != "h" || !(run.spacing > 0) || std::abs(value - run.spacing) <= rounded * run.spacing,
        "The constant \"h\" of the study is {:.6g}, but \"h\" is the size of the cells, "
        "which in this run is {:.6g} m; give the constant another name.",
        value, run.spacing);
    variables[name] = value;
  }
  return variables;
}

double measure(const Quantity& quantity, const RunResults& run, const Variables& variables) {
  switch (quantity.from) {
    case Quantity::From::tables:
      return row_value(quantity, run.rows, variables);
    case Quantity::From::surface:
      return row_value(quantity, read_surface_rows(run.directory, quantity.solid, quantity.point),
                       variables);
    case Quantity::From::line:
      return line_value(quantity, run);
    case Quantity::From::field:
      return field_value(quantity, run, variables);
  }
  return 0;
}

}  // namespace lockstep
