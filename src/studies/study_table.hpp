#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "studies/case_runner.hpp"

namespace lockstep {

/// One quantity at one rung of one series: the mean over the samples.
struct StudyRow {
  std::string series, quantity;
  double cells = 0, spacing = 0, mean_step = 0;
  int ranks = 1;
  double ladder = 0, abscissa = 0;
  double value = 0;
  std::optional<double> reference, error, order;
  double wall_seconds = 0;  ///< mean of a run
  double core_seconds = 0;  ///< CPU seconds of all ranks, those that wait too; mean of a run
  double iterations_median =
      0;                      ///< iterations of coupled solves, the larger of S1's and S2's; mean
  double iterations_max = 0;  ///< largest of all
  double peak_memory_mb = 0;  ///< largest, all ranks of a run together
  double spread = 0;          ///< standard deviation over the samples
  int n_samples = 1;
  int n_at_a_time = 1;  ///< runs of the study while one of these went: more take longer
};

/// Measures the cases that are done: series by series, quantity by quantity, rung by rung. What
/// cannot be measured has no row, and a series whose last rung is not there has no errors against
/// itself; each of these is told as a sentence.
std::vector<StudyRow> study_table(const Study& study, const std::vector<StudyCase>& cases,
                                  const std::vector<CaseOutcome>& outcomes,
                                  const std::function<void(const std::string&)>& tell);

/// The rows of one quantity, series by series.
std::vector<std::vector<StudyRow>> rows_by_series(const std::vector<StudyRow>& rows,
                                                  const std::string& quantity);

/// A name inside a CSV field: no commas, quotes or line breaks.
std::string without_separators(std::string name);

/// The comment of a CSV file that tells the plot a unit; none without one.
std::string unit_line(const std::string& name, const std::string& unit);

/// Returns the table with a commented header that tools/plot-study reads. Numbers that do not exist
/// are left empty.
std::string table_csv(const Study& study, const std::vector<StudyRow>& rows);
/// For people: fewer digits, one table a quantity.
std::string table_markdown(const Study& study, const std::vector<StudyRow>& rows);

}  // namespace lockstep
