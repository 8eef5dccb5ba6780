#include "studies/expression_check.hpp"

#include <algorithm>
#include <set>

#include "base/errors.hpp"
#include "base/regular_file.hpp"
#include "parameters/files/parameter_file.hpp"
#include "parameters/strict_values.hpp"
#include "stepping/report/run_columns.hpp"

namespace lockstep {

namespace {

/// Names that stand in a formula, functions and numbers among them.
std::vector<std::string> names_in(const std::string& formula) {
  const auto is_part = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.';
  };
  std::vector<std::string> names;
  for (std::size_t i = 0; i < formula.size(); ++i) {
    const std::size_t begin = i;
    while (i < formula.size() && is_part(formula[i]))
      ++i;
    if (i > begin)
      names.push_back(formula.substr(begin, i - begin));
  }
  return names;
}

/// The solids of a scene, as far as the file itself says.
struct Bodies {
  std::set<std::string> names;
  std::set<std::string> observers;   ///< only their runs know the columns
  std::vector<std::string> watches;  ///< watched places of the liquid
  bool has_water = false;            ///< a liquid with a surface, which frames have like a solid's
  bool complete = false;
};

Bodies bodies_of(const std::string& scene_file) {
  Bodies bodies;
  std::string failure;
  const std::string text = read_regular_file(scene_file, failure);
  check_input(failure.empty(), "Cannot read the scene '{}': {}.", scene_file, failure);
  try {
    ParameterList scene = read_parameters_text(text, scene_file, FormulaPolicy::kept).list;
    bodies.complete = !scene.isParameter("Include") && !scene.isParameter("Copies");
    for (const auto& [name, entry] : entries(scene.sublist("Solids")))
      bodies.names.insert(variable_name(name));
    for (const auto& [name, entry] : entries(scene.sublist("Observers")))
      bodies.observers.insert(variable_name(name));
    bodies.has_water = scene.sublist("Fluid").isSublist("Free Surface");
    for (const auto& [name, entry] :
         entries(scene.sublist("Fluid").sublist("Free Surface").sublist("Watch")))
      bodies.watches.push_back(variable_name(name));
  } catch (const InputError&) {
    bodies.complete = false;  // simulate will say what is wrong with it
  }
  return bodies;
}

/// Names known to every formula of a run, all with the value 1.
Variables names_of_run(const Study& study, const StudyCase& study_case) {
  Variables variables;
  for (const char* name : {"h", "dt", "cells", "ranks"})
    variables[name] = 1;
  for (const auto& [name, path] : study.parameters)
    variables[name] = 1;
  for (const auto& [name, value] : study_case.constants)
    variables[name] = value;
  return variables;
}

/// True if a name is "OBSERVER.column" or "OBSERVER.2.column".
bool is_observed(const std::string& name, const std::set<std::string>& observers) {
  const std::size_t point = name.rfind('.');
  if (point == std::string::npos || point == 0 || point + 1 == name.size())
    return false;
  if (observers.count(name.substr(0, point)) != 0)
    return true;
  const std::size_t before = name.rfind('.', point - 1);
  if (before == std::string::npos || before + 1 == point)
    return false;
  const std::string row = name.substr(before + 1, point - before - 1);
  return std::all_of(row.begin(), row.end(),
                     [](unsigned char c) { return std::isdigit(c) != 0; }) &&
         observers.count(name.substr(0, before)) != 0;
}

template <typename Columns>
void add_names(const Columns& columns, Variables& variables) {
  for (const HistoryColumn& column : columns)
    variables[column.name] = 1;
}

/// Adds the columns of history.csv, and those of bodies.csv and of observers that the formula
/// names.
void add_columns(const std::string& formula, const Bodies& bodies, Variables& variables) {
  const LiquidColumns all{bodies.watches, true, true};
  add_names(history_columns<2>(all), variables);
  add_names(history_columns<3>(all), variables);
  const auto columns = body_columns<3>();
  const auto add_body = [&](const std::string& body) {
    for (const HistoryColumn& column : columns) {
      if (column.name != "step" && column.name != "time" && column.name != "name")
        variables[body + "." + column.name] = 1;
    }
  };
  std::for_each(bodies.names.begin(), bodies.names.end(), add_body);
  for (const std::string& name : names_in(formula)) {
    const std::size_t point = name.rfind('.');
    const bool is_number = std::isdigit(static_cast<unsigned char>(name.front())) != 0;
    if (!bodies.complete && !is_number && point != std::string::npos && point > 0)
      add_body(name.substr(0, point));
    if (is_observed(name, bodies.observers))
      variables[name] = 1;
  }
}

/// Adds the names of summary.json in the formula, with any value: they are known after a run only.
void add_summary(const std::string& formula, Variables& variables) {
  for (const std::string& name : names_in(formula)) {
    if (name.rfind("summary.", 0) == 0)
      variables[name] = 1;
  }
}

void check_formula(const std::string& formula, Variables variables, const std::string& where) {
  add_summary(formula, variables);
  const Expression parsed(formula, variables, where);
}

void check_quantity(const Quantity& quantity, const Bodies& bodies, const Variables& common) {
  const std::string where = fmt::format("Quantity \"{}\"", quantity.name);
  Variables variables = common;
  if (quantity.from == Quantity::From::tables) {
    add_columns(quantity.expression, bodies, variables);
  } else if (quantity.from == Quantity::From::surface) {
    const bool is_water = bodies.has_water && quantity.solid == "water";
    check_input(
        !bodies.complete || is_water || bodies.names.count(variable_name(quantity.solid)) != 0,
        "{}: the scene has no solid \"{}\".", where, quantity.solid);
    for (const char* name : {"x", "y", "z", "volume", "area", "x_extent", "y_extent", "z_extent"})
      variables[name] = variables[std::string(name) + "0"] = 1;
    variables["time"] = 1;
  } else {
    for (const char* name : {"x", "y", "z", "t"})
      variables[name] = 1;
  }
  if (quantity.from != Quantity::From::line)
    check_formula(quantity.expression, variables, where);
  if (!quantity.reference.empty() && trimmed(quantity.reference) != "self")
    check_formula(quantity.reference, common, fmt::format("Reference of \"{}\"", quantity.name));
}

}  // namespace

void check_expressions(const Study& study, const std::vector<StudyCase>& cases) {
  int last_series = -1;
  for (const StudyCase& one : cases) {
    if (one.series == last_series)
      continue;  // the names are the same for all its rungs
    last_series = one.series;
    const Bodies bodies = bodies_of(one.scene_file);
    const Variables common = names_of_run(study, one);
    check_formula(study.abscissa, common, "\"Ladder/Abscissa\"");
    for (const Quantity& quantity : study.quantities)
      check_quantity(quantity, bodies, common);
    for (const Curve& curve : study.curves) {
      for (const std::string& formula : {curve.expression, curve.exact}) {
        Variables variables = common;
        add_columns(formula, bodies, variables);
        if (!formula.empty())
          check_formula(formula, variables, fmt::format("Curve \"{}\"", curve.name));
      }
    }
  }
}

}  // namespace lockstep
