#include "studies/measure.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/errors.hpp"
#include "studies/frame_field.hpp"

namespace lockstep {

namespace {

double reduce(Quantity::Over over, const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  switch (over) {
    case Quantity::Over::last:
      return values.back();
    case Quantity::Over::first:
      return values.front();
    case Quantity::Over::max:
      return *std::max_element(values.begin(), values.end());
    case Quantity::Over::min:
      return *std::min_element(values.begin(), values.end());
    case Quantity::Over::mean:
      return std::accumulate(values.begin(), values.end(), 0.0) / n;
    case Quantity::Over::rms:
      return std::sqrt(std::inner_product(values.begin(), values.end(), values.begin(), 0.0) / n);
  }
  return 0;
}

double table_value(const Quantity& quantity, const RunResults& run, const Variables& variables) {
  const std::string where = fmt::format("Quantity \"{}\"", quantity.name);
  // The columns come last: a row's own dt, not the mean one.
  Variables all = variables;
  for (const auto& [name, value] : run.rows.front())
    all[name] = value;
  const Expression expression(quantity.expression, all, where);
  std::vector<double> values;
  for (const Variables& row : run.rows) {
    if (row.at("time") < quantity.from_time)
      continue;
    for (const auto& [name, value] : row)
      all[name] = value;
    values.push_back(expression.value());
  }
  check_input(!values.empty(), "{}: no row of {} is later than \"From Time\" = {} s.", where,
              run.directory, quantity.from_time);
  return reduce(quantity.over, values);
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
    return largest;
  return quantity.norm == Quantity::Norm::l1 ? sum / n : std::sqrt(squares / n);
}

}  // namespace

Variables run_variables(const Study& study, const StudyCase& study_case, const RunResults& run) {
  Variables variables = run.summary;
  for (const auto& [name, path] : study.parameters)
    variables[name] = scene_number(run.scene, path);
  variables["h"] = run.spacing;
  variables["dt"] = run.mean_step;
  variables["cells"] = run.n_cells;
  for (const auto& [name, value] : study_case.constants)
    variables[name] = value;
  return variables;
}

double measure(const Quantity& quantity, const RunResults& run, const Variables& variables) {
  return quantity.is_field ? field_value(quantity, run, variables)
                           : table_value(quantity, run, variables);
}

}  // namespace lockstep
