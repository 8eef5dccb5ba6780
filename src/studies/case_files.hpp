#pragma once
#include <string>

#include "studies/study_cases.hpp"

namespace lockstep {

/// Checksums of the scene of a case and of all that it names, one line a file: solver files,
/// meshes, included scenes, those that an assignment names and those that they name. Whatever is
/// written as a string and is the path of a plain file counts.
std::string checksums_of_inputs(const StudyCase& study_case);

}  // namespace lockstep
