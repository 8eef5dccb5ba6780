#pragma once
#include <chrono>
#include <map>
#include <string>
#include <vector>

#include "base/communicator.hpp"

namespace lockstep {

/// Wall time of one phase over the run.
struct PhaseTime {
  std::string name;                               ///< with the phases around it: "step / S2 solve"
  double min_seconds, mean_seconds, max_seconds;  ///< over the ranks
  long long calls;                                ///< on rank 0
};

/// Wall clock of named phases, which nest. (Teuchos::StackedTimer only prints its minima and maxima
/// over the ranks; the summary of a run needs them as numbers.)
class PhaseTimers {
 public:
  PhaseTimers();

  /// Opens a phase inside the one that is open. Not collective.
  void start(const std::string& name);
  /// Closes the phase opened last.
  void stop();

  /// Collective: the phases that rank 0 has closed, each after the phase around it. A rank that
  /// never entered one counts with 0 s.
  std::vector<PhaseTime> report(const Communicator& comm) const;

 private:
  using Clock = std::chrono::steady_clock;
  struct Phase {
    std::string path;
    std::size_t parent;
    std::map<std::string, std::size_t> children;
    double seconds = 0;
    long long calls = 0;
    Clock::time_point started{};
  };
  void append_in_order(std::size_t phase, std::vector<std::size_t>& order) const;

  std::vector<Phase> phases_;  // the first is the root, which has no time of its own
  std::size_t open_ = 0;
};

/// Times the scope it lives in.
class ScopedPhase {
 public:
  ScopedPhase(PhaseTimers& timers, const std::string& name) : timers_(timers) {
    timers_.start(name);
  }
  ~ScopedPhase() { timers_.stop(); }
  ScopedPhase(const ScopedPhase&) = delete;
  ScopedPhase& operator=(const ScopedPhase&) = delete;

 private:
  PhaseTimers& timers_;
};

/// A table for the end of a run: one line a phase.
std::string timing_table(const std::vector<PhaseTime>& phases);

/// That this process, with all its threads, has used so far: user and system time [s]. Other than
/// wall time it does not grow while the process waits for a core. A rank that waits for others
/// inside MPI does use it. Local.
double cpu_seconds();

/// Largest resident memory so far [MB of 10^6 bytes].
struct PeakMemory {
  double largest_rank_mb;
  double all_ranks_mb;
};
/// Collective.
PeakMemory peak_memory_mb(const Communicator& comm);

}  // namespace lockstep
