#include "studies/study.hpp"

#include <algorithm>
#include <regex>

#include "base/errors.hpp"
#include "output/atomic_file.hpp"
#include "parameters/files/parameter_file.hpp"
#include "parameters/strict_values.hpp"
#include "parameters/validate.hpp"
#include "studies/series_product.hpp"

namespace lockstep {

namespace {

const char* const assignments_doc =
    "Changes of the scene, \"List/Name=value\", separated by ';'. What stands in [ ] is a formula "
    "of the constants: \"Domain/Cells={[n], [n]}\".";
const char* const constants_doc =
    "Numbers, or formulas of those before, under names of their own; all are evaluated anew for "
    "each case. A series may replace those of the study; its additional ones come before them. "
    "\"ranks\" is the number of MPI ranks.";

const char* const field_doc =
    "Field of the last frame, such as \"pressure\", or a component of it, \"velocity[1]\"; without "
    "brackets the first.";

/// Beyond this a typing error is likelier than a study, and takes the machine down.
constexpr int most_samples = 10000;

ParameterList series_parameters() {
  ParameterList series;
  declare_optional<std::string>(series, "Scene", "Another scene, relative to the study file.");
  declare_free_sublist(series, "Constants", constants_doc);
  declare(series, "Set", "", assignments_doc);
  declare_optional<ParameterArray<double>>(series, "Values",
                                           "Ladder of this series, instead of the study's.");
  return series;
}

/// Options of a factor of the series.
ParameterList factor_parameters() {
  ParameterList factor;
  declare_named_sublists(factor, "Options",
                         "The choices, one sublist each; their names make up those of the series.",
                         series_parameters());
  return factor;
}

void declare_unit(ParameterList& list, const std::string& of) {
  declare(list, "Unit", "",
          fmt::format("Unit of {}, for plots: \"m/s\"; \"1\" without dimension.", of));
}

void declare_targets(ParameterList& list) {
  declare(list, "Targets", ParameterArray<double>(),
          "Errors whose cost is reported: in how many core seconds, with how many cells and how "
          "much memory each series reaches them, cheapest first.");
  set_positive(list, "Targets");
}

void declare_reference(ParameterList& list) {
  declare(list, "Reference", "",
          "Reference value: a formula of the constants and parameters, or \"self\": the value at "
          "the last rung of the series. Empty: no error is reported.");
  declare(list, "Relative", true, "Divide the error by the size of the reference, unless it is 0.");
}

void declare_reduction(ParameterList& list) {
  declare_choice(list, "Over", "last",
                 {"last", "first", "max", "min", "mean", "rms", "amplitude", "frequency"},
                 "How the rows of a run become one number; every row counts the same. amplitude: "
                 "half of max - min. frequency: of the rises through 0 [1/s].");
  declare_optional<double>(list, "Start", "Rows before this time do not count [s].");
  declare_reference(list);
  declare_targets(list);
}

std::vector<TypedSchema> quantity_types() {
  ParameterList table, surface, field, line;
  declare_required<std::string>(
      table, "Expression",
      "Formula of the columns of history.csv, of bodies.csv as BODY.column, of the tables of "
      "observers as OBSERVER.column or, where a look has several rows, OBSERVER.2.column, of "
      "summary.json as summary.name, of constants, parameters and h, dt, cells, ranks.");
  declare_reduction(table);
  declare_required<std::string>(surface, "Solid",
                                "Name of the solid, or \"water\" for the surface of a liquid.");
  declare_required<ParameterArray<double>>(
      surface, "Point", "Picks the vertex of the surface that is nearest at the start [m].");
  declare_required<std::string>(
      surface, "Expression",
      "Formula of time; x, y, z, of that vertex, x0, y0, z0 at the start [m]; volume [m^3] (2D: "
      "[m^2]) inside the surface, or between an open one and its rim if the rim lies in a plane "
      "(2D: line) with \"Point\"; area [m^2] (2D: [m]); x_extent, y_extent, z_extent [m]; volume0, "
      "area0 and so on; constants, parameters and "
      "h, dt, cells, ranks.");
  declare_reduction(surface);
  declare_required<std::string>(field, "Field", field_doc);
  declare_required<std::string>(field, "Reference",
                                "Formula of x, y, z, t, constants and parameters.");
  declare_choice(field, "Over", "L2", {"L1", "L2", "max"},
                 "Of the difference, per unit volume: mean of |e|, root of the mean of e^2, max "
                 "|e|. It is value and error at once.");
  declare_targets(field);
  declare_required<std::string>(line, "Field", field_doc);
  declare_choice(line, "Axis", "x", {"x", "y", "z"}, "Along which the line runs.");
  declare_required<ParameterArray<double>>(line, "Point", "That the line goes through [m].");
  declare_choice(
      line, "Over", "max", {"max", "min"},
      "The extremum wanted: of the parabola through three neighbouring centres of cells; "
      "across the line values are linear between cells.");
  declare_reference(line);
  declare_targets(line);
  for (ParameterList* list : {&table, &surface, &field, &line})
    declare_unit(*list, "its values");
  return {{"table", "A quantity from the tables of a run.", table},
          {"surface", "A quantity from a solid's surface in the frames of a run, one row a frame.",
           surface},
          {"field", "Difference of a cell-centred field to an exact solution.", field},
          {"line", "Extremum of a cell-centred field along a line parallel to an axis.", line}};
}

ParameterList curve_parameters() {
  ParameterList curve;
  declare_required<std::string>(curve, "Expression",
                                "Formula of the columns of the tables, as for a quantity.");
  declare(curve, "Reference", "", "Formula of what it should be, of the same; drawn dashed.");
  declare_unit(curve, "its values");
  return curve;
}

Formulas read_formulas(const ParameterList& list, const std::string& where) {
  Formulas formulas;
  for (const auto& [name, entry] : entries(list)) {
    check_input(variable_name(name) == name,
                "{}: \"{}\" cannot be used in formulas; write it with letters, digits and _.",
                where, name);
    formulas.emplace_back(name, value_text(entry));
  }
  return formulas;
}

std::vector<std::string> read_assignments(const std::string& text, const std::string& where) {
  std::vector<std::string> assignments;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(';', begin), text.size());
    const std::string assignment = trimmed(text.substr(begin, end - begin));
    begin = end + 1;
    if (assignment.empty())
      continue;
    check_input(assignment.find('=') != std::string::npos,
                "{}: \"{}\" is no assignment; write \"List/Name=value\".", where, assignment);
    assignments.push_back(assignment);
  }
  return assignments;
}

Series read_series(const ParameterList& list, const std::string& name, const std::string& file,
                   const std::string& scene) {
  Series series;
  const std::string where = fmt::format("{}, series \"{}\"", file, name);
  series.name = name;
  series.scene_file =
      resolve_path(file, list.isParameter("Scene") ? list.get<std::string>("Scene") : scene);
  series.constants = read_formulas(list.sublist("Constants"), where);
  series.assignments = read_assignments(list.get<std::string>("Set"), where);
  if (list.isParameter("Values"))
    series.values = list.get<ParameterArray<double>>("Values").toVector();
  return series;
}

std::vector<Series> read_all_series(const ParameterList& study, const std::string& file) {
  const auto& scene = study.get<std::string>("Scene");
  const auto read_list = [&](const ParameterList& list) {
    std::vector<Series> all;
    for (const auto& [name, entry] : entries(list))
      all.push_back(read_series(Teuchos::getValue<ParameterList>(entry), name, file, scene));
    return all;
  };
  const Series plain{"", resolve_path(file, scene), {}, {}, {}};
  std::vector<Series> series = read_list(study.sublist("Series"));
  std::vector<std::vector<Series>> factors;
  for (const auto& [name, entry] : entries(study.sublist("Factors"))) {
    factors.push_back(read_list(Teuchos::getValue<ParameterList>(entry).sublist("Options")));
    check_input(!factors.back().empty(), "{}: the factor \"{}\" has no \"Options\".", file, name);
  }
  for (Series& one : series_product(factors, plain))
    series.push_back(std::move(one));
  if (series.empty()) {
    series.push_back(plain);
    series.back().name = "all";
  }
  return series;
}

template <typename Value>
Value choice(const std::string& text, const std::vector<std::pair<const char*, Value>>& values) {
  return std::find_if(values.begin(), values.end(),
                      [&](const auto& value) { return text == value.first; })
      ->second;
}

void read_point(const ParameterList& list, const std::string& name, Quantity& quantity) {
  const auto& point = list.get<ParameterArray<double>>("Point");
  check_input(point.size() == 2 || point.size() == 3,
              "In quantity \"{}\", \"Point\" has {} components; it must have 2 or 3.", name,
              point.size());
  std::copy(point.begin(), point.end(), quantity.point.begin());
}

/// "velocity[1]" or, without brackets, the only component or the first.
void read_field(const ParameterList& list, const std::string& name, Quantity& quantity) {
  const auto& text = list.get<std::string>("Field");
  std::smatch parts;
  check_input(
      std::regex_match(text, parts, std::regex(R"(([^\[\]]+)(?:\[(\d)\])?)")),
      "In quantity \"{}\", \"Field\" is \"{}\"; it is the name of a field, or of a component "
      "of it as in \"velocity[1]\".",
      name, text);
  quantity.field = parts[1];
  quantity.component = parts[2].matched ? std::stoi(parts[2]) : 0;
}

void read_line(const ParameterList& list, const std::string& name, Quantity& quantity) {
  read_point(list, name, quantity);
  read_field(list, name, quantity);
  quantity.axis = choice<int>(list.get<std::string>("Axis"), {{"x", 0}, {"y", 1}, {"z", 2}});
  quantity.over = choice<Quantity::Over>(
      list.get<std::string>("Over"), {{"max", Quantity::Over::max}, {"min", Quantity::Over::min}});
  quantity.reference = list.get<std::string>("Reference");
  quantity.relative = list.get<bool>("Relative");
}

Quantity read_quantity(const ParameterList& list, const std::string& name) {
  using From = Quantity::From;
  using Over = Quantity::Over;
  using Norm = Quantity::Norm;
  Quantity quantity;
  quantity.name = name;
  quantity.unit = list.get<std::string>("Unit");
  quantity.targets = list.get<ParameterArray<double>>("Targets").toVector();
  quantity.from = choice<From>(list.get<std::string>("Type"), {{"table", From::tables},
                                                               {"surface", From::surface},
                                                               {"field", From::field},
                                                               {"line", From::line}});
  if (quantity.from == From::field) {
    quantity.expression = list.get<std::string>("Reference");
    read_field(list, name, quantity);
    quantity.norm = choice<Norm>(list.get<std::string>("Over"),
                                 {{"L1", Norm::l1}, {"L2", Norm::l2}, {"max", Norm::max}});
    quantity.reference = "0";
    return quantity;
  }
  if (quantity.from == From::line) {
    read_line(list, name, quantity);
    return quantity;
  }
  quantity.expression = list.get<std::string>("Expression");
  quantity.over = choice<Over>(list.get<std::string>("Over"), {{"last", Over::last},
                                                               {"first", Over::first},
                                                               {"max", Over::max},
                                                               {"min", Over::min},
                                                               {"mean", Over::mean},
                                                               {"rms", Over::rms},
                                                               {"amplitude", Over::amplitude},
                                                               {"frequency", Over::frequency}});
  if (quantity.from == From::surface) {
    quantity.solid = list.get<std::string>("Solid");
    read_point(list, name, quantity);
  }
  if (list.isParameter("Start"))
    quantity.from_time = list.get<double>("Start");
  quantity.reference = list.get<std::string>("Reference");
  quantity.relative = list.get<bool>("Relative");
  return quantity;
}

}  // namespace

bool is_resolution(const Study& study) {
  const std::string abscissa = trimmed(study.abscissa);
  return abscissa == "h" || abscissa == "dt" || abscissa != study.ladder_name;
}

ParameterList study_parameters() {
  ParameterList study("Study");
  declare(study, "Title", "", "One line on what the study shows.");
  declare_required<std::string>(study, "Scene", "The scene that is varied, relative to this file.");
  declare_free_sublist(study, "Constants", constants_doc);
  declare_free_sublist(study, "Parameters",
                       "Parameters of the scene for use in formulas of the quantities: a name of "
                       "their own, and the path as string, \"Fluid/Density\" or, for a component, "
                       "\"Fluid/Gravity[1]\".");
  declare(study, "Set", "", assignments_doc);
  ParameterList& ladder = declare_list(study, "Ladder", "Constant that varies along each series.");
  declare(ladder, "Name", "n",
          "Name of the constant that takes the values. \"ranks\" also sets the MPI ranks.");
  declare_required<ParameterArray<double>>(ladder, "Values", "One rung each, the finest last.");
  declare_at_least(ladder, "Usual Rungs", 0, 0,
                   "Number of rungs that are run unless --rungs says otherwise; 0: all.");
  declare(ladder, "Abscissa", "",
          "Formula of the abscissa, against which errors are plotted, of constants, h, dt, cells, "
          "ranks. Left out: dt along a ladder named dt, else h. Orders "
          "of convergence are taken in it, unless it is the ladder's constant itself (and not h or "
          "dt): along density ratios, say, there are none.");
  declare(ladder, "Title", "", "Name of the abscissa in plots; h, dt, cells and ranks have one.");
  declare_unit(ladder, "the abscissa");
  declare_named_sublists(study, "Series", "The lines of the plot; without any there is one.",
                         series_parameters());
  declare_named_sublists(
      study, "Factors",
      "More series: one for every choice of one option of each factor, such as discretization, "
      "strategy and time step. An option says what a series can say.",
      factor_parameters());
  ParameterList& samples = declare_list(
      study, "Samples",
      "Each case is run several times with other offsets, and values are averaged. offset_x, "
      "offset_y, offset_z in [-1/2, 1/2) are additive sequences of irrational steps, the same on "
      "every "
      "machine; sample is 0, 1, ...");
  declare_between(samples, "Count", 1, 1, most_samples, "How many.");
  declare(samples, "Set", "", assignments_doc);
  declare_named_sublists(study, "Quantities", "Measured quantities, one sublist each.",
                         quantity_types(), "table");
  declare_named_sublists(study, "Curves", "Curves over time, one picture each.",
                         curve_parameters());
  return study;
}

Study read_study(const std::string& file) {
  Document document = read_parameters_text(read_whole_file(file), file);
  validate(document, study_parameters());
  const ParameterList& list = document.list;
  const ParameterList& ladder = list.sublist("Ladder");
  Study study;
  study.title = list.get<std::string>("Title");
  study.constants = read_formulas(list.sublist("Constants"), file);
  for (const auto& [name, entry] : entries(list.sublist("Parameters")))
    study.parameters.emplace_back(name, value_text(entry));
  study.assignments = read_assignments(list.get<std::string>("Set"), file);
  study.ladder_name = ladder.get<std::string>("Name");
  study.ladder_values = ladder.get<ParameterArray<double>>("Values").toVector();
  study.usual_rungs = ladder.get<int>("Usual Rungs");
  study.abscissa = ladder.get<std::string>("Abscissa");
  if (study.abscissa.empty())
    study.abscissa = study.ladder_name == "dt" ? "dt" : "h";
  study.abscissa_name = ladder.get<std::string>("Title");
  study.abscissa_unit = ladder.get<std::string>("Unit");
  study.series = read_all_series(list, file);
  study.n_samples = list.sublist("Samples").get<int>("Count");
  study.sample_assignments =
      read_assignments(list.sublist("Samples").get<std::string>("Set"), file);
  for (const auto& [name, entry] : entries(list.sublist("Quantities")))
    study.quantities.push_back(read_quantity(Teuchos::getValue<ParameterList>(entry), name));
  for (const auto& [name, entry] : entries(list.sublist("Curves"))) {
    const auto& curve = Teuchos::getValue<ParameterList>(entry);
    study.curves.push_back({name, curve.get<std::string>("Expression"),
                            curve.get<std::string>("Reference"), curve.get<std::string>("Unit")});
  }
  check_input(!study.quantities.empty(), "{}: the study measures nothing; name a quantity.", file);
  check_input(!study.ladder_values.empty(), "{}: the ladder has no \"Values\".", file);
  return study;
}

void keep_series(const std::string& pattern, Study& study) {
  std::regex expression;
  try {
    expression = pattern;
  } catch (const std::regex_error& error) {
    throw InputError(
        fmt::format("--series: \"{}\" is no regular expression ({}).", pattern, error.what()));
  }
  std::vector<Series> kept;
  std::string names;
  for (Series& series : study.series) {
    names += (names.empty() ? "" : "; ") + series.name;
    if (std::regex_match(series.name, expression))
      kept.push_back(std::move(series));
  }
  check_input(!kept.empty(), "--series: no series matches \"{}\" as a whole. The study has: {}.",
              pattern, names);
  study.series = std::move(kept);
}

}  // namespace lockstep
