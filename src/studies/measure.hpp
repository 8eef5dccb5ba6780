#pragma once
#include "studies/run_results.hpp"
#include "studies/study_cases.hpp"

namespace lockstep {

/// All that formulas may use after a run, besides the columns of its tables: the constants of the
/// case, the study's parameters, the summary, h, dt (mean), cells.
Variables run_variables(const Study& study, const StudyCase& study_case, const RunResults& run);

/// The quantity of one run. `variables` are those of run_variables. Throws InputError for formulas
/// that cannot be evaluated.
double measure(const Quantity& quantity, const RunResults& run, const Variables& variables);

}  // namespace lockstep
