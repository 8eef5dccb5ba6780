#include "studies/study_table.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "base/errors.hpp"
#include "parameters/strict_values.hpp"
#include "studies/measure.hpp"

namespace lockstep {

namespace {

/// The finished samples of one rung of one series.
struct Rung {
  const StudyCase* first = nullptr;
  std::vector<RunResults> runs;
  std::vector<Variables> variables;
  int n_at_a_time = 1;
};

/// Reads the results of a case; none, and a sentence, if they cannot be read.
std::optional<std::pair<RunResults, Variables>> read_case(
    const Study& study, const StudyCase& one, const CaseOutcome& outcome,
    const std::function<void(const std::string&)>& tell) {
  try {
    RunResults run = read_run(outcome.directory);
    Variables variables = run_variables(study, one, run);
    return std::pair(std::move(run), std::move(variables));
  } catch (const Failure& failure) {
    tell(fmt::format("{}: not measured. {}", one.directory, failure.what()));
    return std::nullopt;
  }
}

std::vector<Rung> read_rungs(const Study& study, int series, const std::vector<StudyCase>& cases,
                             const std::vector<CaseOutcome>& outcomes,
                             const std::function<void(const std::string&)>& tell) {
  std::vector<Rung> rungs;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    if (cases[i].series != series || !outcomes[i].done)
      continue;
    auto found = read_case(study, cases[i], outcomes[i], tell);
    if (!found)
      continue;
    if (rungs.empty() || rungs.back().first->rung != cases[i].rung) {
      rungs.emplace_back();
      rungs.back().first = &cases[i];
    }
    rungs.back().runs.push_back(std::move(found->first));
    rungs.back().variables.push_back(std::move(found->second));
    rungs.back().n_at_a_time = std::max(rungs.back().n_at_a_time, outcomes[i].n_at_a_time);
  }
  return rungs;
}

double summary_number(const RunResults& run, const std::string& name) {
  const auto found = run.summary.find("summary." + name);
  return found == run.summary.end() ? 0 : found->second;
}

void add_cost(StudyRow& row, const Rung& rung) {
  const auto n = static_cast<double>(rung.runs.size());
  for (const RunResults& run : rung.runs) {
    row.wall_seconds += run.wall_seconds / n;
    row.core_seconds += run.cpu_seconds / n;
    row.iterations_median += std::max(summary_number(run, "iterations.s1.median"),
                                      summary_number(run, "iterations.s2.median")) /
                             n;
    row.iterations_max = std::max({row.iterations_max, summary_number(run, "iterations.s1.max"),
                                   summary_number(run, "iterations.s2.max")});
    row.peak_memory_mb = std::max(row.peak_memory_mb, summary_number(run, "peak_memory_mb"));
  }
}

/// Samples may differ in what a formula asks for.
double sample_mean(const Rung& rung, const std::string& formula, const std::string& where) {
  double sum = 0;
  for (const Variables& variables : rung.variables)
    sum += evaluate(formula, variables, where);
  return sum / static_cast<double>(rung.variables.size());
}

StudyRow make_row(const Study& study, const Quantity& quantity, const Rung& rung) {
  StudyRow row;
  row.series = study.series[rung.first->series].name;
  row.quantity = quantity.name;
  row.cells = rung.runs.front().n_cells;
  row.spacing = rung.runs.front().spacing;
  row.mean_step = rung.runs.front().mean_step;
  row.ranks = rung.first->ranks;
  row.ladder = rung.first->constants.at(study.ladder_name);
  row.abscissa = sample_mean(rung, study.abscissa, "\"Ladder/Abscissa\"");
  row.n_samples = static_cast<int>(rung.runs.size());
  row.n_at_a_time = rung.n_at_a_time;
  std::vector<double> values;
  for (std::size_t k = 0; k < rung.runs.size(); ++k)
    values.push_back(measure(quantity, rung.runs[k], rung.variables[k]));
  for (const double value : values)
    row.value += value / row.n_samples;
  for (const double value : values)
    row.spread += (value - row.value) * (value - row.value);
  row.spread = row.n_samples > 1 ? std::sqrt(row.spread / (row.n_samples - 1)) : 0;
  add_cost(row, rung);
  return row;
}

/// Adds the orders of rows along a ladder of resolutions, each from the one before it.
void add_orders(std::vector<StudyRow>& rows) {
  for (std::size_t r = 1; r < rows.size(); ++r) {
    const StudyRow& before = rows[r - 1];
    StudyRow& row = rows[r];
    const bool ordered = row.error && *before.error > 0 && *row.error > 0 && before.abscissa > 0 &&
                         row.abscissa > 0 && before.abscissa != row.abscissa;
    if (ordered)
      row.order = std::log(*before.error / *row.error) / std::log(before.abscissa / row.abscissa);
  }
}

bool is_against_self(const Quantity& quantity) {
  return trimmed(quantity.reference) == "self";
}

/// Adds the errors of `rows`, which belong to `rungs` one by one. `is_whole`: the last rung is the
/// last of the series.
void add_errors(std::vector<StudyRow>& rows, const Quantity& quantity,
                const std::vector<const Rung*>& rungs, bool is_whole) {
  if (quantity.reference.empty() || rows.empty())
    return;
  const bool self = is_against_self(quantity);
  if (self && !is_whole)
    return;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    StudyRow& row = rows[r];
    if (self && r + 1 == rows.size())
      break;
    row.reference = self ? rows.back().value
                         : sample_mean(*rungs[r], quantity.reference,
                                       fmt::format("Reference of \"{}\"", quantity.name));
    const double scale = quantity.relative && *row.reference != 0 ? std::abs(*row.reference) : 1.0;
    row.error = std::abs(row.value - *row.reference) / scale;
  }
}

/// The rows of one quantity in one series.
std::vector<StudyRow> rows_of(const Study& study, const Quantity& quantity,
                              const std::vector<Rung>& rungs, int last_rung,
                              const std::function<void(const std::string&)>& tell) {
  std::vector<StudyRow> rows;
  std::vector<const Rung*> measured;
  for (const Rung& rung : rungs) {
    try {
      rows.push_back(make_row(study, quantity, rung));
      measured.push_back(&rung);
    } catch (const Failure& failure) {
      tell(fmt::format("{}: \"{}\" is not measured. {}", rung.first->directory, quantity.name,
                       failure.what()));
    }
  }
  const bool is_whole = !measured.empty() && measured.back()->first->rung == last_rung;
  if (!rows.empty() && !is_whole && is_against_self(quantity))
    tell(
        fmt::format("\"{}\" of series \"{}\" has no errors: its last rung, which is the "
                    "reference, is missing.",
                    quantity.name, rows.front().series));
  add_errors(rows, quantity, measured, is_whole);
  if (is_resolution(study))
    add_orders(rows);
  return rows;
}

std::string text(const std::optional<double>& number) {
  return number ? number_text(*number) : "";
}

std::string short_text(const std::optional<double>& number, int digits) {
  return number ? fmt::format("{:.{}g}", *number, digits) : "";
}

/// Comments that the plot reads.
std::string plot_lines(const Study& study) {
  std::string lines;
  if (!study.abscissa_name.empty())
    lines += fmt::format("# abscissa name: {}\n", study.abscissa_name);
  if (!study.abscissa_unit.empty())
    lines += fmt::format("# abscissa unit: {}\n", study.abscissa_unit);
  for (const Quantity& quantity : study.quantities) {
    lines += unit_line(quantity.name, quantity.unit);
    if (is_against_self(quantity))
      lines += fmt::format("# reference of {}: self\n", without_separators(quantity.name));
    if (!quantity.targets.empty())
      lines += fmt::format("# targets of {}: {}\n", without_separators(quantity.name),
                           fmt::join(quantity.targets, " "));
  }
  return lines;
}

}  // namespace

std::string unit_line(const std::string& name, const std::string& unit) {
  return unit.empty() ? "" : fmt::format("# unit of {}: {}\n", without_separators(name), unit);
}

std::string without_separators(std::string name) {
  std::replace_if(
      name.begin(), name.end(), [](char c) { return c == ',' || c == '\n' || c == '"'; }, ';');
  return name;
}

std::vector<StudyRow> study_table(const Study& study, const std::vector<StudyCase>& cases,
                                  const std::vector<CaseOutcome>& outcomes,
                                  const std::function<void(const std::string&)>& tell) {
  std::vector<StudyRow> table;
  for (int s = 0; s < static_cast<int>(study.series.size()); ++s) {
    const std::vector<Rung> rungs = read_rungs(study, s, cases, outcomes, tell);
    int last_rung = 0;  // last rung that was asked for
    for (const StudyCase& one : cases)
      last_rung = one.series == s ? std::max(last_rung, one.rung) : last_rung;
    for (const Quantity& quantity : study.quantities) {
      const std::vector<StudyRow> rows = rows_of(study, quantity, rungs, last_rung, tell);
      table.insert(table.end(), rows.begin(), rows.end());
    }
  }
  return table;
}

std::vector<std::vector<StudyRow>> rows_by_series(const std::vector<StudyRow>& rows,
                                                  const std::string& quantity) {
  std::vector<std::vector<StudyRow>> by_series;
  for (const StudyRow& row : rows) {
    if (row.quantity != quantity)
      continue;
    if (by_series.empty() || by_series.back().front().series != row.series)
      by_series.emplace_back();
    by_series.back().push_back(row);
  }
  return by_series;
}

std::string table_csv(const Study& study, const std::vector<StudyRow>& rows) {
  std::string csv = fmt::format(
      "# title: {}\n# abscissa: {}\n# ladder: {}\n"
      "# cells: of the whole box; h [m], dt [s]: mean of a run; error: relative to the reference "
      "unless that is 0\n"
      "# wall_seconds, core_seconds [s]: of one run; core_seconds: CPU seconds of all ranks; MPI "
      "ranks that wait count\n"
      "# spread: standard deviation over the samples\n"
      "# at_a_time: runs of the study, at most, while this one went; more than 1 take longer\n"
      "{}series,cells,h,dt,ranks,quantity,value,reference,error,order,wall_seconds,core_seconds,"
      "iterations_median,iterations_max,peak_memory_mb,spread,samples,abscissa,at_a_time\n",
      study.title, study.abscissa, study.ladder_name, plot_lines(study));
  for (const StudyRow& row : rows) {
    csv += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n",
                       without_separators(row.series), row.cells, number_text(row.spacing),
                       number_text(row.mean_step), row.ranks, without_separators(row.quantity),
                       number_text(row.value), text(row.reference), text(row.error),
                       text(row.order), row.wall_seconds, row.core_seconds, row.iterations_median,
                       row.iterations_max, row.peak_memory_mb, number_text(row.spread),
                       row.n_samples, number_text(row.abscissa), row.n_at_a_time);
  }
  return csv;
}

std::string table_markdown(const Study& study, const std::vector<StudyRow>& rows) {
  std::string page = study.title.empty() ? "" : fmt::format("{}\n\n", study.title);
  for (const Quantity& quantity : study.quantities) {
    page += fmt::format(
        "**{}**{}\n\n"
        "| series | {} | cells | h | dt | ranks | value | spread | reference | error | order | "
        "core seconds | iterations (median, max) | memory [MB] |\n"
        "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n",
        quantity.name,
        is_against_self(quantity) ? ", reference `self`: the finest run of each series" : "",
        study.ladder_name);
    for (const StudyRow& row : rows) {
      if (row.quantity != quantity.name)
        continue;
      const std::string spread = row.n_samples > 1 ? fmt::format("{:.2g}", row.spread) : "";
      page += fmt::format(
          "| {} | {:.6g} | {:.0f} | {:.4g} | {:.4g} | {} | {:.7g} | {} | {} | {} | {} | {:.2g}{} | "
          "{:.3g}, {:.0f} | {:.0f} |\n",
          row.series, row.ladder, row.cells, row.spacing, row.mean_step, row.ranks, row.value,
          spread, short_text(row.reference, 7), short_text(row.error, 3), short_text(row.order, 3),
          row.core_seconds, row.n_at_a_time > 1 ? fmt::format(" ({})", row.n_at_a_time) : "",
          row.iterations_median, row.iterations_max, row.peak_memory_mb);
    }
    page += "\n";
  }
  page += "Core seconds are CPU seconds of all ranks of a run; MPI ranks that wait count.\n\n";
  if (std::any_of(rows.begin(), rows.end(),
                  [](const StudyRow& row) { return row.n_at_a_time > 1; }))
    page +=
        "Seconds with a number in brackets are of runs that shared the machine with others of the "
        "study: "
        "up to so many at a time, which makes each of them slower.\n\n";
  return page;
}

}  // namespace lockstep
