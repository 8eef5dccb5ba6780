#include "studies/run_results.hpp"

#include <nlohmann/json.hpp>

#include <charconv>
#include <cstdlib>
#include <sstream>

#include "base/errors.hpp"
#include "output/atomic_file.hpp"
#include "output/csv_line.hpp"
#include "parameters/files/strict_xml.hpp"
#include "parameters/parameter_rule.hpp"

namespace lockstep {

namespace {

using Row = std::map<std::string, std::string>;

std::vector<Row> read_csv(const std::string& file) {
  std::istringstream stream(read_whole_file(file));
  std::vector<std::string> names;
  std::vector<Row> rows;
  for (std::string line; std::getline(stream, line);) {
    if (line.empty() || line.front() == '#')
      continue;
    const std::vector<std::string> parts = csv_fields(line);
    if (names.empty()) {
      names = parts;
      continue;
    }
    check_output(parts.size() == names.size(), "{}: a row has {} columns instead of {}: {}", file,
                 parts.size(), names.size(), line);
    Row row;
    for (std::size_t i = 0; i < names.size(); ++i)
      row[names[i]] = parts[i];
    rows.push_back(std::move(row));
  }
  return rows;
}

double number(const Row& row, const std::string& column, const std::string& file) {
  const auto found = row.find(column);
  check_output(found != row.end(), "{} has no column \"{}\".", file, column);
  char* end = nullptr;
  const double value = std::strtod(found->second.c_str(), &end);
  check_output(!found->second.empty() && *end == '\0', "{}: \"{}\" in column \"{}\" is no number.",
               file, found->second, column);
  return value;
}

void read_tables(const std::string& directory, std::vector<Variables>& rows) {
  const std::string history = directory + "/history.csv", bodies = directory + "/bodies.csv";
  std::map<double, std::size_t> row_of_step;
  for (const Row& line : read_csv(history)) {
    row_of_step[number(line, "step", history)] = rows.size();
    Variables row;
    for (const auto& [name, text] : line)
      row[name] = number(line, name, history);
    rows.push_back(std::move(row));
  }
  for (const Row& line : read_csv(bodies)) {
    const auto row = row_of_step.find(number(line, "step", bodies));
    if (row == row_of_step.end())
      continue;
    for (const auto& [name, text] : line) {
      if (name != "step" && name != "time" && name != "name") {
        rows[row->second][variable_name(line.at("name")) + "." + name] = number(line, name, bodies);
      }
    }
  }
}

/// Adds an observer's table to the rows of steps: its last look by then. With several rows a look,
/// "NAME.2.column" is of the second.
void read_observer(const std::string& directory, const std::string& name,
                   std::vector<Variables>& rows) {
  const std::string file = directory + "/" + name + ".csv";
  std::map<double, std::vector<Row>> looks;  // by step
  for (Row& line : read_csv(file))
    looks[number(line, "step", file)].push_back(std::move(line));
  for (Variables& row : rows) {
    auto look = looks.upper_bound(row.at("step"));
    if (look == looks.begin())
      continue;
    const std::vector<Row>& lines = (--look)->second;
    for (std::size_t i = 0; i < lines.size(); ++i) {
      std::string prefix = variable_name(name) + ".";
      if (lines.size() > 1)
        prefix += std::to_string(i + 1) + ".";
      for (const auto& [column, text] : lines[i])
        if (column != "step" && column != "time")
          row[prefix + column] = number(lines[i], column, file);
    }
  }
}

void flatten(const nlohmann::json& json, const std::string& prefix, Variables& result) {
  for (const auto& [name, value] : json.items()) {
    const std::string path = prefix + "." + variable_name(name);
    if (value.is_object())
      flatten(value, path, result);
    else if (value.is_number())
      result[path] = value.get<double>();
  }
}

}  // namespace

RunResults read_run(const std::string& directory) {
  RunResults run;
  run.directory = directory;
  read_tables(directory, run.rows);
  check_output(!run.rows.empty(), "{}/history.csv holds no step.", directory);
  const std::string summary = directory + "/summary.json";
  try {
    flatten(nlohmann::json::parse(read_whole_file(summary)), "summary", run.summary);
  } catch (const nlohmann::json::exception& error) {
    throw OutputError(fmt::format("{} is not proper JSON: {}.", summary, error.what()));
  }
  const std::string parameters = directory + "/used-parameters.xml";
  run.scene = read_xml_string(read_whole_file(parameters), parameters).list;
  if (run.scene.isSublist("Observers"))
    for (const auto& [name, entry] : entries(run.scene.sublist("Observers")))
      read_observer(directory, name, run.rows);
  const auto fact = [&](const std::string& name) {
    const auto found = run.summary.find("summary." + name);
    check_output(found != run.summary.end(),
                 "{} does not hold \"{}\": an older program wrote it, or another one; remove this "
                 "folder and let the case run again.",
                 summary, name);
    return found->second;
  };
  run.n_cells = fact("cells");
  run.spacing = fact("smallest_length");
  run.wall_seconds = fact("wall_seconds");
  run.cpu_seconds = fact("cpu_seconds");
  for (const Variables& row : run.rows)
    run.mean_step += row.at("dt") / static_cast<double>(run.rows.size());
  return run;
}

double scene_number(const ParameterList& scene, const std::string& path) {
  std::string name = path;
  std::size_t component = 0;
  const std::size_t open = path.find('[');
  if (open != std::string::npos) {
    const char* begin = path.data() + open + 1;
    const auto [end, error] = std::from_chars(begin, path.data() + path.size(), component);
    check_input(error == std::errc() && std::string(end) == "]",
                "\"{}\": a component is written as \"Fluid/Gravity[1]\".", path);
    name = path.substr(0, open);
  }
  const ParameterList* list = &scene;
  std::size_t begin = 0;
  for (std::size_t slash = name.find('/'); slash != std::string::npos;
       begin = slash + 1, slash = name.find('/', begin)) {
    const std::string part = name.substr(begin, slash - begin);
    check_input(list->isSublist(part), "The scene has no list \"{}\" on the way to \"{}\".", part,
                path);
    list = &list->sublist(part);
  }
  const std::string leaf = name.substr(begin);
  if (list->isType<double>(leaf))
    return list->get<double>(leaf);
  if (list->isType<int>(leaf))
    return list->get<int>(leaf);
  if (list->isType<ParameterArray<double>>(leaf) &&
      component < static_cast<std::size_t>(list->get<ParameterArray<double>>(leaf).size()))
    return list->get<ParameterArray<double>>(leaf)[component];
  if (list->isType<ParameterArray<int>>(leaf) &&
      component < static_cast<std::size_t>(list->get<ParameterArray<int>>(leaf).size()))
    return list->get<ParameterArray<int>>(leaf)[component];
  throw InputError(fmt::format("The scene has no number \"{}\".", path));
}

}  // namespace lockstep
