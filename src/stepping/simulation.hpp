#pragma once
#include <chrono>
#include <optional>
#include <string>

#include "output/folder_lock.hpp"
#include "output/frames.hpp"
#include "output/schedule.hpp"
#include "solve/dumping_strategy.hpp"
#include "stepping/build_components.hpp"
#include "stepping/explanation.hpp"
#include "stepping/report/observer_tables.hpp"
#include "stepping/report/run_tables.hpp"
#include "stepping/run_cost.hpp"
#include "stepping/run_summary.hpp"
#include "stepping/run_warnings.hpp"
#include "stepping/scene.hpp"

namespace lockstep {

/// Options of a run: where it writes and how it starts.
struct RunOptions {
  std::string scene_file;  ///< empty: none; then paths of files are relative to where it runs
  std::string output_directory;
  std::string restart_file;        ///< empty: from the scene's start
  std::string command_line;        ///< for the banner
  std::optional<long long> steps;  ///< --steps and --end-time override the scene
  std::optional<double> end_time;
  std::optional<DumpRequest> dump_system;  ///< write one system of the run to a file
};

/// The fields on boxes and on surfaces that a frame holds.
struct Frame {
  std::vector<BoxFrame> boxes;
  std::vector<SurfaceFrame> meshes;
};

/// A run of one scene: builds it, steps it, writes tables, frames, checkpoints and the summary.
template <int dim>
class Simulation {
 public:
  /// `scene` is validated. Collective; throws InputError for what only building reveals.
  Simulation(const Registries<dim>& registries, const ParameterList& scene,
             const RunOptions& options, const Communicator& comm, const Log& log);

  /// Tells what is active, why, and what it costs in memory; for --explain and --validate. To tell
  /// how long the run takes it may take the first step, in memory alone; then nothing else may
  /// follow. Collective.
  std::string explain(bool takes_step);
  /// Runs to the end or to a signal; returns the exit code (0, or 128 + signal). Collective.
  int run();

  // Parts of `run`, for programs that look at a run, or push it, between its steps. Collective.
  /// Writes the start, or loads the checkpoint; once, before all steps.
  void begin();
  /// Takes a step and writes what is due. False, and no step, at the end of the scene and after a
  /// signal that was asked for (base/signals.hpp). Once it has thrown, solids and fluid may be at
  /// different times: then it throws InputError, and so does `end`.
  bool step();
  /// The last checkpoint, unless a signal has ended the last step between its stages, and the
  /// summary; once, after all steps.
  void end();
  /// In place of `end`, where the program around the run has failed: says so in summary.json. On
  /// one rank with the last checkpoint; on several not all may have failed, so this is not
  /// collective. What the run itself threw is told already.
  void stop(const std::string& message);

  double time() const { return scheme_->time(); }  ///< [s]
  long long n_steps() const { return step_; }      ///< with those before a restart
  /// Of the last step; null before the first that this object takes.
  const StepReport<dim>* report() const { return report_ ? &*report_ : nullptr; }
  /// The row of history.csv of the last step, by column. Local.
  std::vector<std::pair<std::string, HistoryValue>> history_row() const;
  Components<dim>& components() { return components_; }
  /// Fields that a frame shows at present. Collective.
  Frame frame() const;

 private:
  StepBound next_step();
  bool finished() const;
  /// False if a signal ended it between two of its stages, because it takes long. Collective.
  bool take_step(double dt, std::chrono::steady_clock::time_point start);
  void write_rows();
  void write_what_is_due();
  bool checkpoint_is_due();
  /// Calls f; what it throws is told to summary.json too.
  template <typename Function>
  void recorded(const Function& f);
  void begin_outputs();
  /// Throws InputError if another run writes to the folder.
  void lock_folder();
  void begin_tables();
  void end_outputs();
  /// On rank 0, not collective: others may have failed elsewhere.
  void record_ending(const std::string& status, const std::string& message) const noexcept;
  RunView<dim> view(const std::vector<SolidState<dim>>& states) const;
  void check_names() const;
  void write_frame();
  void write_checkpoint();
  void load_checkpoint();
  void resume_frames();
  double fraction_done() const;
  /// After each step in turn, as Schedule::reach: whether a frame is due.
  bool reach_frame();

  std::unique_ptr<FolderLock> folder_lock_;  // on rank 0, until the last is written
  ParameterList scene_;
  RunOptions options_;
  Communicator comm_;
  const Log& log_;
  StageTimers timers_;
  Components<dim> components_;
  SceneOptions scene_options_;
  std::unique_ptr<TimeScheme<dim>> scheme_;
  RunTables<dim> tables_;
  ObserverTables<dim> observers_;
  FrameWriter frames_;
  Schedule frame_times_;  ///< in simulated time or, without an interval, in parts of the run
  Schedule checkpoint_times_;
  WallClockSchedule checkpoint_clock_;  ///< where the scene gives no interval of them
  static constexpr double never_ = -1e300;
  RunOrigin origin_;   ///< commit, scene and parameters of this run
  std::string files_;  // checksums of those that the solids are read from
  long long step_ = 0, first_step_ = 0;
  RunWarnings<dim> warnings_;
  double last_dt_ = 0;
  std::string bound_of_step_;                 ///< bound of the last step; empty: the CFL number
  double last_frame_ = never_;                ///< time of the last frame that was due [s]
  double fraction_at_begin_ = 0;              ///< part of the run done before this program [1]
  const DumpingStrategy* dumping_ = nullptr;  ///< strategy of --dump-system; `components_` owns it
  std::optional<StepReport<dim>> report_;     ///< report of the last step
  double step_seconds_ = 0;                   ///< wall time of the last step [s]
  int signal_ = 0;                            ///< signal that ended the run; 0: none
  bool is_within_step_ =
      false;             ///< in memory is no state between steps, because a signal ended one
  bool failed_ = false;  ///< the state in memory is of no use
  std::chrono::steady_clock::time_point start_;
  double cpu_seconds_at_start_ = 0;  ///< used by this process before `start_`
  RunSummary summary_;
  nlohmann::ordered_json header_;
};

}  // namespace lockstep
