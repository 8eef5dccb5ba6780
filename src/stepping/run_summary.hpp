#pragma once
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "interfaces/constraint.hpp"
#include "output/timers.hpp"
#include "stepping/report/step_report.hpp"

namespace lockstep {

/// Facts of a run in summary.json, besides those of its steps.
struct RunFacts {
  std::string status;
  long long n_steps = 0, step = 0;  ///< taken by this program, and the number of the last
  double time = 0;                  ///< [s]
  std::size_t n_pressures = 0;
  double n_cells = 0;          ///< cells of the boxes in frames; without boxes pressures
  double smallest_length = 0;  ///< smallest length that the fluid resolves [m]
  GlobalIndex n_solid_unknowns = 0;
  double wall_seconds = 0, cpu_seconds = 0;  ///< times of this rank, once the scene is built [s]
};

/// Part of summary.json that is known before the first step: versions, ranks, machine, command, and
/// the process of rank 0 with the time of its start. Not collective.
nlohmann::ordered_json run_header(const Communicator& comm, const std::string& command_line);

/// summary.json of a run without an end: "running", or "failed" or "stopped by an exception" with
/// the reason.
nlohmann::ordered_json unfinished_summary(const std::string& status, const std::string& message,
                                          const nlohmann::ordered_json& header);

/// Adds up the steps of a run for summary.json.
class RunSummary {
 public:
  template <int dim>
  void count(const StepReport<dim>& report) {
    count(report.s1, report.f2, report.s2);
    largest_momentum_error_ = larger(report.momentum_error, largest_momentum_error_);
    largest_angular_error_ = larger(report.angular_momentum_error, largest_angular_error_);
  }
  /// After a step.
  void count(const std::vector<JointState>& joints);
  /// Collective.
  nlohmann::ordered_json json(const nlohmann::ordered_json& header, const RunFacts& run,
                              const std::vector<StageTime>& stages, const Communicator& comm) const;

 private:
  void count(const SolveReport& s1, const SolveReport& f2, const SolveReport& s2);
  /// nan, of what is not audited, stays.
  static double larger(double value, double largest) { return value <= largest ? largest : value; }

  using Counts = std::map<int, long>;  ///< by their number of iterations: solves
  Counts s1_iterations_, f2_iterations_, s2_iterations_;
  double largest_momentum_error_ = 0, largest_angular_error_ = 0, worst_residual_ = 0;
  int preconditioner_builds_ = 0, preconditioner_reuses_ = 0;
  long stored_nonzeros_ = 0;
  bool has_joints_ = false;
  long end_impulses_ = 0, limited_torques_ = 0;  ///< steps
};

}  // namespace lockstep
