#include "output/timers.hpp"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <ctime>
#include <sstream>

#include "base/errors.hpp"

namespace lockstep {

StageTimers::StageTimers() : stages_(1) {}

void StageTimers::start(const std::string& name) {
  const auto [found, is_new] = stages_[open_].children.try_emplace(name, stages_.size());
  const std::size_t stage = found->second;
  if (is_new) {
    Stage added;
    added.path = open_ == 0 ? name : stages_[open_].path + " / " + name;
    added.parent = open_;
    stages_.push_back(added);
  }
  open_ = stage;
  stages_[open_].started = Clock::now();
}

void StageTimers::stop() {
  LOCKSTEP_ASSERT(open_ != 0);
  Stage& stage = stages_[open_];
  stage.seconds += std::chrono::duration<double>(Clock::now() - stage.started).count();
  ++stage.calls;
  open_ = stage.parent;
}

void StageTimers::append_in_order(std::size_t stage, std::vector<std::size_t>& order) const {
  if (stages_[stage].calls > 0)
    order.push_back(stage);
  std::vector<std::size_t> children;
  for (const auto& child : stages_[stage].children) {
    children.push_back(child.second);
  }
  std::sort(children.begin(), children.end());
  for (const std::size_t child : children) {
    append_in_order(child, order);
  }
}

std::vector<StageTime> StageTimers::report(const Communicator& comm) const {
  std::vector<std::size_t> order;
  append_in_order(0, order);
  std::string paths;
  for (const std::size_t stage : order) {
    paths += stages_[stage].path + "\n";
  }
  long long length = static_cast<long long>(paths.size());
  MPI_Bcast(&length, 1, MPI_LONG_LONG, 0, raw_communicator(comm));
  paths.resize(static_cast<std::size_t>(length));
  MPI_Bcast(paths.data(), static_cast<int>(length), MPI_CHAR, 0, raw_communicator(comm));

  std::vector<StageTime> times;
  std::istringstream lines(paths);
  for (std::string path; std::getline(lines, path);) {
    const auto same = [&](const Stage& stage) { return stage.path == path; };
    const auto found = std::find_if(stages_.begin(), stages_.end(), same);
    const double seconds = found == stages_.end() ? 0.0 : found->seconds;
    long long calls = found == stages_.end() ? 0 : found->calls;
    MPI_Bcast(&calls, 1, MPI_LONG_LONG, 0, raw_communicator(comm));
    times.push_back({path, min_all(comm, seconds), sum_all(comm, seconds) / comm->getSize(),
                     max_all(comm, seconds), calls});
  }
  return times;
}

std::string timing_table(const std::vector<StageTime>& stages) {
  std::size_t width = 5;
  for (const StageTime& stage : stages) {
    width = std::max(width, stage.name.size());
  }
  std::string text = fmt::format("{:<{}}  {:>8}  {:>10}  {:>10}  {:>10}", "stage", width, "calls",
                                 "min [s]", "mean [s]", "max [s]");
  for (const StageTime& stage : stages) {
    text += fmt::format("\n{:<{}}  {:>8}  {:>10.3f}  {:>10.3f}  {:>10.3f}", stage.name, width,
                        stage.calls, stage.min_seconds, stage.mean_seconds, stage.max_seconds);
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
