#pragma once
#include <functional>
#include <string>
#include <vector>

#include "studies/study_cases.hpp"

namespace lockstep {

struct RunnerOptions {
  std::string simulate;               ///< the executable
  std::vector<std::string> plug_ins;  ///< libraries that it loads
  std::string output_directory;       ///< runs go to its folder "runs"
  int n_jobs = 1;                     ///< cases at a time
  bool fresh = false;                 ///< do not re-use runs
  double seconds_to_wait = 10;        ///< for runs that a killed study has left behind
};

/// Outcome of a case.
struct CaseOutcome {
  bool done = false;  ///< false also for cases not started after bad input
  bool reused = false;
  int exit_code = 0;
  int n_at_a_time = 1;    ///< runs of the study, at most, while this one went; seconds know it
  double seconds = 0;     ///< from its start to its end; 0 if reused
  std::string directory;  ///< folder of its output
  std::string message;    ///< complaint of the child
};

/// Runs every case that has no finished run of the same scene, files that it names, assignments,
/// ranks and executable. One call at a time in a folder: throws OutputError if another works there.
/// A failed case does not stop the others, unless its input was bad: then no further one is
/// started. What runs when a study is killed is run anew from its start by the next call: seconds
/// and iterations of a case are those of one run. By one thread at a time, `started` is called
/// before each run with the number of its case and the file of its log, `report` after each case
/// with its number and outcome.
std::vector<CaseOutcome> run_cases(
    const std::vector<StudyCase>& cases, const RunnerOptions& options,
    const std::function<void(std::size_t, const CaseOutcome&)>& report,
    const std::function<void(std::size_t, const std::string&)>& started = {});

}  // namespace lockstep
