#include "studies/study_cases.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/errors.hpp"
#include "parameters/strict_values.hpp"

namespace lockstep {

namespace {

void add_constants(Variables& variables, const Formulas& formulas, const Formulas& replacements,
                   const std::string& where) {
  // the last of several counts, as for assignments
  const auto in = [](const Formulas& list, const std::string& name) {
    const auto last = std::find_if(list.rbegin(), list.rend(),
                                   [&](const auto& formula) { return formula.first == name; });
    return last == list.rend() ? list.end() : std::prev(last.base());
  };
  // The constants of the series come first, unless they replace one of the study, which keeps its
  // place.
  for (const auto& [name, formula] : replacements) {
    if (in(formulas, name) == formulas.end())
      variables[name] = evaluate(formula, variables, where);
  }
  for (const auto& [name, formula] : formulas) {
    const auto replacement = in(replacements, name);
    variables[name] = evaluate(replacement == replacements.end() ? formula : replacement->second,
                               variables, where);
  }
}

/// Beyond this a typing error is likelier than a study, and takes the machine down.
constexpr int most_ranks = 4096;

void add_assignments(StudyCase& result, const std::vector<std::string>& assignments,
                     const std::string& where) {
  for (const std::string& assignment : assignments)
    result.assignments.push_back(substitute(assignment, result.constants, where));
}

/// A name for a folder: no slashes or other surprises. Different names stay different, but for a
/// blank and '-'.
std::string folder_name(const std::string& text) {
  std::string result;
  for (const char c : text) {
    const bool kept = std::isalnum(static_cast<unsigned char>(c)) != 0 ||
                      std::string("-+._=,").find(c) != std::string::npos;
    if (c == ' ') {
      result += '-';
    } else if (kept && !(c == '.' && result.empty())) {
      result += c;
    } else {
      result += fmt::format("%{:02X}", static_cast<unsigned char>(c));
    }
  }
  return result;
}

StudyCase make_case(const Study& study, int series_number, int rung, int sample, double value) {
  const Series& series = study.series[series_number];
  const std::string where =
      fmt::format("Series \"{}\", {} = {}", series.name, study.ladder_name, number_text(value));
  StudyCase result;
  result.series = series_number;
  result.rung = rung;
  result.sample = sample;
  result.scene_file = series.scene_file;
  Variables& constants = result.constants;
  constants["ranks"] = 1;
  constants[study.ladder_name] = value;
  constants["rung"] = rung + 1;
  constants["sample"] = sample;
  for (int axis = 0; axis < 3; ++axis)
    constants[std::string("offset_") + "xyz"[axis]] = sample_offset(sample, axis);
  add_constants(constants, study.constants, series.constants, where);
  const double ranks = constants["ranks"];
  check_input(ranks >= 1 && ranks <= most_ranks && ranks == std::floor(ranks),
              "{}: \"ranks\" is {:g}, but must be a whole number, at least 1 and at most {}.",
              where, ranks, most_ranks);
  result.ranks = static_cast<int>(ranks);
  add_assignments(result, study.assignments, where);
  add_assignments(result, series.assignments, where);
  add_assignments(result, study.sample_assignments, where);
  result.directory = fmt::format("{}/{}={}", folder_name(series.name),
                                 folder_name(study.ladder_name), folder_name(number_text(value)));
  if (study.n_samples > 1)
    result.directory += fmt::format("/sample-{}", sample);
  return result;
}

/// No two cases may write to the same place.
void check_folders(const Study& study, const std::vector<StudyCase>& cases) {
  std::map<std::string, const StudyCase*> of_folder;
  for (const StudyCase& one : cases) {
    const auto [known, is_new] = of_folder.emplace(one.directory, &one);
    check_input(
        is_new,
        "The series \"{}\" and \"{}\" both have a case in the folder \"{}\": give them other "
        "names, and each rung of a ladder another value.",
        study.series[known->second->series].name, study.series[one.series].name, one.directory);
  }
}

}  // namespace

double sample_offset(int sample, int axis) {
  // Irrational steps: powers of the plastic number for the plane, the golden section across it.
  constexpr double steps[] = {0.75487766624669276, 0.56984029099805327, 0.61803398874989485};
  const double position = sample * steps[axis];
  return position - std::floor(position + 0.5);
}

RungRange parse_rungs(const std::string& text) {
  const auto number = [&text](const std::string& part, int standard) {
    if (part.empty())
      return standard;
    const bool digits = part.find_first_not_of("0123456789") == std::string::npos;
    check_input(digits && part.size() < 6 && std::stoi(part) > 0,
                "--rungs \"{}\": write first:last, counted from 1, as in 2:4.", text);
    return std::stoi(part);
  };
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos)
    return {number(text, 1), number(text, 1)};
  RungRange range{number(text.substr(0, colon), 1), number(text.substr(colon + 1), 1 << 20)};
  check_input(range.first <= range.last, "--rungs \"{}\": the first rung is after the last.", text);
  return range;
}

std::vector<StudyCase> study_cases(const Study& study, const RungRange& rungs) {
  std::vector<StudyCase> cases;
  for (int s = 0; s < static_cast<int>(study.series.size()); ++s) {
    const std::vector<double>& values =
        study.series[s].values.empty() ? study.ladder_values : study.series[s].values;
    const int n = static_cast<int>(values.size());
    const int usual = study.usual_rungs > 0 ? std::min(study.usual_rungs, n) : n;
    const int first = rungs.first > 0 ? rungs.first : 1;
    const int last = rungs.last > 0 ? std::min(rungs.last, n) : usual;
    for (int r = first - 1; r < last; ++r) {
      for (int k = 0; k < study.n_samples; ++k)
        cases.push_back(make_case(study, s, r, k, values[r]));
    }
  }
  check_folders(study, cases);
  check_input(!cases.empty(), "--rungs {}:{}: no ladder of this study has such rungs.", rungs.first,
              rungs.last);
  return cases;
}

}  // namespace lockstep
