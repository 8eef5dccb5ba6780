#pragma once
#include <chrono>
#include <map>
#include <string>
#include <vector>

#include "base/communicator.hpp"

namespace lockstep {

/// Wall time of one stage over the run.
struct StageTime {
  std::string name;                               ///< with the stages around it: "step / S2 solve"
  double min_seconds, mean_seconds, max_seconds;  ///< over the ranks
  long long calls;                                ///< on rank 0
};

/// Wall clock of named stages, which nest. (Teuchos::StackedTimer only prints its minima and maxima
/// over the ranks; the summary of a run needs them as numbers.)
class StageTimers {
 public:
  StageTimers();

  /// Opens a stage inside the one that is open. Not collective.
  void start(const std::string& name);
  /// Closes the stage opened last.
  void stop();

  /// Collective: the stages that rank 0 has closed, each after the stage around it. A rank that
  /// never entered one counts with 0 s.
  std::vector<StageTime> report(const Communicator& comm) const;

 private:
  using Clock = std::chrono::steady_clock;
  struct Stage {
    std::string path;
    std::size_t parent;
    std::map<std::string, std::size_t> children;
    double seconds = 0;
    long long calls = 0;
    Clock::time_point started{};
  };
  void append_in_order(std::size_t stage, std::vector<std::size_t>& order) const;

  std::vector<Stage> stages_;  // the first is the root, which has no time of its own
  std::size_t open_ = 0;
};

/// Times the scope it lives in.
class ScopedStage {
 public:
  ScopedStage(StageTimers& timers, const std::string& name) : timers_(timers) {
    timers_.start(name);
  }
  ~ScopedStage() { timers_.stop(); }
  ScopedStage(const ScopedStage&) = delete;
  ScopedStage& operator=(const ScopedStage&) = delete;

 private:
  StageTimers& timers_;
};

/// A table for the end of a run: one line a stage.
std::string timing_table(const std::vector<StageTime>& stages);

/// CPU seconds that this process, with all its threads, has used so far: user and system time [s].
/// Other than wall time it does not grow while the process waits for a core. A rank that waits for
/// others inside MPI does use it. Local.
double cpu_seconds();

/// Largest resident memory so far [MB of 10^6 bytes].
struct PeakMemory {
  double largest_rank_mb;
  double all_ranks_mb;
};
/// Collective.
PeakMemory peak_memory_mb(const Communicator& comm);

}  // namespace lockstep
