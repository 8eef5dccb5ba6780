#include "studies/curves.hpp"

#include "base/errors.hpp"
#include "parameters/strict_values.hpp"
#include "studies/measure.hpp"
#include "studies/study_table.hpp"

namespace lockstep {
namespace {

std::string curve_lines(const Curve& curve, const std::string& prefix, const RunResults& run,
                        Variables all) {
  const std::string where = fmt::format("Curve \"{}\"", curve.name);
  for (const auto& [name, value] : run.rows.front())
    all[name] = value;
  const Expression value_of(curve.expression, all, where);
  const Expression exact_of(curve.exact.empty() ? "0" : curve.exact, all, where);
  std::string lines;
  for (const Variables& row : run.rows) {
    for (const auto& [name, value] : row)
      all[name] = value;
    const std::string exact = curve.exact.empty() ? "" : number_text(exact_of.value());
    lines += fmt::format("{},{},{},{}\n", prefix, number_text(row.at("time")),
                         number_text(value_of.value()), exact);
  }
  return lines;
}

}  // namespace

std::string curves_csv(const Study& study, const std::vector<StudyCase>& cases,
                       const std::vector<CaseOutcome>& outcomes,
                       const std::function<void(const std::string&)>& tell) {
  std::string csv;
  for (const Curve& curve : study.curves) {
    for (std::size_t i = 0; i < cases.size(); ++i) {
      if (!outcomes[i].done || cases[i].sample != 0)
        continue;
      const std::string prefix = fmt::format("{},{},{}", without_separators(curve.name),
                                             without_separators(study.series[cases[i].series].name),
                                             number_text(cases[i].constants.at(study.ladder_name)));
      try {
        const RunResults run = read_run(outcomes[i].directory);
        csv += curve_lines(curve, prefix, run, run_variables(study, cases[i], run));
      } catch (const Failure& failure) {
        tell(fmt::format("{}: the curve \"{}\" is not drawn. {}", cases[i].directory, curve.name,
                         failure.what()));
      }
    }
  }
  std::string units;
  for (const Curve& curve : study.curves)
    units += unit_line(curve.name, curve.unit);
  const std::string head =
      fmt::format("# title: {}\n# ladder: {}\n{}curve,series,ladder,time,value,exact\n",
                  study.title, study.ladder_name, units);
  return csv.empty() ? "" : head + csv;
}

}  // namespace lockstep
