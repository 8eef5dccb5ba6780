#include "stepping/run_summary.hpp"

#include <unistd.h>

#include <algorithm>
#include <ctime>

#include "output/provenance/build_information.hpp"
#include "output/provenance/machine.hpp"

namespace lockstep {

namespace {

/// The upper one if there are two.
int median(const std::map<int, long>& counts) {
  long n = 0, passed = 0;
  for (const auto& [value, count] : counts)
    n += count;
  for (const auto& [value, count] : counts) {
    passed += count;
    if (2 * passed > n)
      return value;
  }
  return 0;
}

nlohmann::ordered_json iteration_summary(const std::map<int, long>& counts) {
  return {{"median", median(counts)}, {"max", counts.empty() ? 0 : counts.rbegin()->first}};
}

}  // namespace

nlohmann::ordered_json run_header(const Communicator& comm, const std::string& command_line) {
  const BuildInformation build = build_information();
  const Machine machine = this_machine();
  return {{"versions",
           {{"lockstep", build.version},
            {"git", build.git_hash},
            {"build", build.build_type},
            {"compiler", build.compiler},
            {"trilinos", build.trilinos},
            {"mpi", build.mpi},
            {"hdf5", build.hdf5}}},
          {"ranks", comm->getSize()},
          {"machine",
           {{"host", machine.host},
            {"processor", machine.processor},
            {"cores", machine.cores},
            {"system", machine.system}}},
          {"command", command_line},
          {"process", getpid()},
          {"started", std::time(nullptr)}};
}

nlohmann::ordered_json unfinished_summary(const std::string& status, const std::string& message,
                                          const nlohmann::ordered_json& header) {
  nlohmann::ordered_json summary = {{"status", status}};
  if (!message.empty())
    summary["message"] = message;
  summary.update(header);
  return summary;
}

void RunSummary::count(const SolveReport& s1, const SolveReport& f2, const SolveReport& s2) {
  ++s1_iterations_[s1.iterations];
  ++f2_iterations_[f2.iterations];
  ++s2_iterations_[s2.iterations];
  for (const SolveReport* solve : {&s1, &f2, &s2}) {
    worst_residual_ = std::max({worst_residual_, solve->pressure_residual, solve->solid_residual});
    preconditioner_builds_ += solve->preconditioner_builds;
    preconditioner_reuses_ += solve->preconditioner_reuses;
    stored_nonzeros_ = std::max(stored_nonzeros_, solve->stored_nonzeros);
  }
}

void RunSummary::count(const std::vector<JointState>& joints) {
  const bool at_end = std::any_of(joints.begin(), joints.end(),
                                  [](const JointState& joint) { return !joint.two_halves; });
  const bool limited = std::any_of(joints.begin(), joints.end(),
                                   [](const JointState& joint) { return joint.at_largest_torque; });
  has_joints_ = true;
  end_impulses_ += at_end ? 1 : 0;
  limited_torques_ += limited ? 1 : 0;
}

nlohmann::ordered_json RunSummary::json(const nlohmann::ordered_json& header, const RunFacts& run,
                                        const std::vector<StageTime>& stages,
                                        const Communicator& comm) const {
  const PeakMemory memory = peak_memory_mb(comm);
  nlohmann::ordered_json stage_times = nlohmann::ordered_json::array();
  for (const StageTime& stage : stages) {
    stage_times.push_back({{"name", stage.name},
                           {"min_seconds", stage.min_seconds},
                           {"mean_seconds", stage.mean_seconds},
                           {"max_seconds", stage.max_seconds},
                           {"calls", stage.calls}});
  }
  nlohmann::ordered_json summary = unfinished_summary(run.status, "", header);
  summary.update(nlohmann::ordered_json{{"steps", run.n_steps},
                                        {"step", run.step},
                                        {"time", run.time},
                                        {"pressure_unknowns", run.n_pressures},
                                        {"cells", run.n_cells},
                                        {"smallest_length", run.smallest_length},
                                        {"solid_unknowns", run.n_solid_unknowns},
                                        {"iterations",
                                         {{"s1", iteration_summary(s1_iterations_)},
                                          {"f2", iteration_summary(f2_iterations_)},
                                          {"s2", iteration_summary(s2_iterations_)}}},
                                        {"largest_momentum_error", largest_momentum_error_},
                                        {"largest_angular_momentum_error", largest_angular_error_},
                                        {"worst_residual", worst_residual_},
                                        {"preconditioner_builds", preconditioner_builds_},
                                        {"preconditioner_reuses", preconditioner_reuses_},
                                        {"stored_nonzeros", stored_nonzeros_},
                                        {"wall_seconds", run.wall_seconds},
                                        {"cpu_seconds", sum_all(comm, run.cpu_seconds)},
                                        {"peak_memory_mb", memory.all_ranks_mb},
                                        {"peak_memory_largest_rank_mb", memory.largest_rank_mb},
                                        {"stages", stage_times}});
  if (has_joints_)
    summary["joints"] = {{"steps_of_end_impulses", end_impulses_},
                         {"steps_of_limited_torques", limited_torques_}};
  return summary;
}

}  // namespace lockstep
