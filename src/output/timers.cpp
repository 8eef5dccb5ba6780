#include "output/timers.hpp"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <ctime>
#include <sstream>

#include "base/errors.hpp"

namespace lockstep {

PhaseTimers::PhaseTimers() : phases_(1) {}

void PhaseTimers::start(const std::string& name) {
  const auto [found, is_new] = phases_[open_].children.try_emplace(name, phases_.size());
  const std::size_t phase = found->second;
  if (is_new) {
    Phase added;
    added.path = open_ == 0 ? name : phases_[open_].path + " / " + name;
    added.parent = open_;
    phases_.push_back(added);
  }
  open_ = phase;
  phases_[open_].started = Clock::now();
}

void PhaseTimers::stop() {
  LOCKSTEP_ASSERT(open_ != 0);
  Phase& phase = phases_[open_];
  phase.seconds += std::chrono::duration<double>(Clock::now() - phase.started).count();
  ++phase.calls;
  open_ = phase.parent;
}

void PhaseTimers::append_in_order(std::size_t phase, std::vector<std::size_t>& order) const {
  if (phases_[phase].calls > 0)
    order.push_back(phase);
  std::vector<std::size_t> children;
  for (const auto& child : phases_[phase].children) {
    children.push_back(child.second);
  }
  std::sort(children.begin(), children.end());
  for (const std::size_t child : children) {
    append_in_order(child, order);
  }
}

std::vector<PhaseTime> PhaseTimers::report(const Communicator& comm) const {
  std::vector<std::size_t> order;
  append_in_order(0, order);
  std::string paths;
  for (const std::size_t phase : order) {
    paths += phases_[phase].path + "\n";
  }
  long long length = static_cast<long long>(paths.size());
  MPI_Bcast(&length, 1, MPI_LONG_LONG, 0, raw_communicator(comm));
  paths.resize(static_cast<std::size_t>(length));
  MPI_Bcast(paths.data(), static_cast<int>(length), MPI_CHAR, 0, raw_communicator(comm));

  std::vector<PhaseTime> times;
  std::istringstream lines(paths);
  for (std::string path; std::getline(lines, path);) {
    const auto same = [&](const Phase& phase) { return phase.path == path; };
    const auto found = std::find_if(phases_.begin(), phases_.end(), same);
    const double seconds = found == phases_.end() ? 0.0 : found->seconds;
    long long calls = found == phases_.end() ? 0 : found->calls;
    MPI_Bcast(&calls, 1, MPI_LONG_LONG, 0, raw_communicator(comm));
    times.push_back({path, min_all(comm, seconds), sum_all(comm, seconds) / comm->getSize(),
                     max_all(comm, seconds), calls});
  }
  return times;
}

std::string timing_table(const std::vector<PhaseTime>& phases) {
  std::size_t width = 5;
  for (const PhaseTime& phase : phases) {
    width = std::max(width, phase.name.size());
  }
  std::string text = fmt::format("{:<{}}  {:>8}  {:>10}  {:>10}  {:>10}", "phase", width, "calls",
                                 "min [s]", "mean [s]", "max [s]");
  for (const PhaseTime& phase : phases) {
    text += fmt::format("\n{:<{}}  {:>8}  {:>10.3f}  {:>10.3f}  {:>10.3f}", phase.name, width,
                        phase.calls, phase.min_seconds, phase.mean_seconds, phase.max_seconds);
  }
  return text;
}

double cpu_seconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

PeakMemory peak_memory_mb(const Communicator& comm) {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const double mine = static_cast<double>(usage.ru_maxrss) * 1024.0 / 1e6;
  return {max_all(comm, mine), sum_all(comm, mine)};
}

}  // namespace lockstep
