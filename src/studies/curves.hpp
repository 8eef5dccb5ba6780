#pragma once
#include <functional>
#include <string>
#include <vector>

#include "studies/case_runner.hpp"

namespace lockstep {

/// Curves over time of every finished case (its first sample): a row "curve,series,ladder,time,
/// value,exact" for each row of the run's tables, with a commented header that tools/plot-curves
/// reads. Empty if there are none. A curve of a case that cannot be read, or whose formula is no
/// number somewhere, is left out and told.
std::string curves_csv(const Study& study, const std::vector<StudyCase>& cases,
                       const std::vector<CaseOutcome>& outcomes,
                       const std::function<void(const std::string&)>& tell);

}  // namespace lockstep
