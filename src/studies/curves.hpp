#pragma once
#include <string>
#include <vector>

#include "studies/case_runner.hpp"

namespace lockstep {

/// Curves over time of every finished case (its first sample): a row "curve,series,ladder,time,
/// value,exact" for each row of the run's tables, with a commented header that tools/plot-curves
/// reads. Empty if the study asks for none. Throws InputError for formulas that cannot be
/// evaluated.
std::string curves_csv(const Study& study, const std::vector<StudyCase>& cases,
                       const std::vector<CaseOutcome>& outcomes);

}  // namespace lockstep
