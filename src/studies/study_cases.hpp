#pragma once
#include <string>
#include <vector>

#include "studies/study.hpp"

namespace lockstep {

/// One run of `simulate`.
struct StudyCase {
  int series = 0, rung = 0, sample = 0;
  int ranks = 1;
  std::string scene_file;
  Variables constants;                   ///< all that formulas may use before the run
  std::vector<std::string> assignments;  ///< for --set, formulas replaced
  std::string directory;                 ///< below DIR/runs: "voxel/n=32/sample-3"
};

/// Rungs first to last, counted from 1. Zeros: the usual ones of the study.
struct RungRange {
  int first = 0, last = 0;
};
/// "2:4", "3", "2:" or ":3". Throws InputError.
RungRange parse_rungs(const std::string& text);

/// All cases, series by series, rung by rung, sample by sample. Throws InputError for formulas that
/// cannot be evaluated, rungs that do not exist and cases that would share a folder.
std::vector<StudyCase> study_cases(const Study& study, const RungRange& rungs);

/// Component `axis` of the offset of a sample, in [-1/2, 1/2): sample 0 is at the centre, and any
/// number of samples covers the square or cube evenly.
double sample_offset(int sample, int axis);

}  // namespace lockstep
