#pragma once
#include "studies/study_cases.hpp"

namespace lockstep {

/// Checks all formulas of a study before anything runs: their syntax, and that the names in them
/// are columns of the tables, solids of the scene, constants or parameters. Bodies are not checked
/// where the scene leaves them to copies or to other files. Throws InputError.
void check_expressions(const Study& study, const std::vector<StudyCase>& cases);

}  // namespace lockstep
