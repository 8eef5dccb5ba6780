#pragma once
#include <chrono>
#include <optional>
#include <string>

#include "output/frames.hpp"
#include "solve/dumping_strategy.hpp"
#include "stepping/observer_tables.hpp"
#include "stepping/run_summary.hpp"
#include "stepping/run_tables.hpp"
#include "stepping/scene.hpp"

namespace lockstep {

/// Where a run writes and how it starts.
struct RunOptions {
  std::string scene_file;
  std::string output_directory;
  std::string restart_file;        ///< empty: from the scene's start
  std::string command_line;        ///< for the banner
  std::optional<long long> steps;  ///< --steps and --end-time override the scene
  std::optional<double> end_time;
  std::optional<DumpRequest> dump_system;  ///< write one system of the run to a file
};

/// A run of one scene: builds it, steps it, writes tables, frames, checkpoints and the summary.
template <int dim>
class Simulation {
 public:
  /// `scene` is validated. Collective; throws InputError for what only building reveals.
  Simulation(const Registries<dim>& registries, const ParameterList& scene,
             const RunOptions& options, const Communicator& comm, const Log& log);

  /// What is active, why, and what it costs in memory; for --explain and --validate.
  std::string explain();
  /// Runs to the end or to a signal; returns the exit code (0, or 128 + signal). Collective.
  int run();

 private:
  double next_step() const;
  bool finished() const;
  /// The step's report; null if a signal ended it, whose number `signal` then is. Collective.
  std::optional<StepReport<dim>> take_step(double dt, int& signal);
  void begin_outputs();
  /// Steps until the end or a signal, whose number is returned; 0 at the end.
  int take_steps(std::chrono::steady_clock::time_point start);
  void end_outputs(int signal, double wall_seconds);
  /// On rank 0, not collective: others may have failed elsewhere.
  void record_failure(const std::string& message) const noexcept;
  RunView<dim> view(const std::vector<SolidState<dim>>& states) const;
  void check_names() const;
  void write_frame();
  void write_checkpoint();
  void load_checkpoint();
  double fraction_done() const;
  void warn(const StepReport<dim>& report);

  ParameterList scene_;
  RunOptions options_;
  SceneOptions scene_options_;
  Communicator comm_;
  const Log& log_;
  PhaseTimers timers_;
  Components<dim> components_;
  std::unique_ptr<Stepper<dim>> stepper_;
  RunTables<dim> tables_;
  ObserverTables<dim> observers_;
  FrameWriter frames_;
  std::string files_;  // checksums of those that the solids are read from
  long long step_ = 0, first_step_ = 0;
  bool warned_of_viscous_step_ = false;
  double last_dt_ = 0, last_frame_ = -1e300, last_checkpoint_ = 0;
  RunSummary summary_;
  nlohmann::ordered_json header_;
};

}  // namespace lockstep
