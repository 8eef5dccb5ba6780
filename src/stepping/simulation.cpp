#include "stepping/simulation.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "base/errors.hpp"
#include "base/signals.hpp"
#include "coupling/solid_totals.hpp"
#include "interfaces/liquid.hpp"
#include "interfaces/solid_sides.hpp"
#include "output/checkpoint.hpp"
#include "output/run_record.hpp"
#include "output/xdmf.hpp"
#include "parameters/mistakes.hpp"
#include "parameters/write.hpp"
#include "stepping/settle.hpp"
#include "stepping/surface_frames.hpp"

namespace lockstep {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Number of cells of a fluid's boxes in frames, those without fluid included; without boxes, of
/// its pressures.
template <int dim>
double n_cells(const FluidDiscretization<dim>& fluid) {
  std::vector<BoxFrame> boxes;
  if (const auto* output = fluid.output())
    output->add_frame(boxes);
  double n = 0;
  for (const BoxFrame& box : boxes)
    n += double(box.n_cells[0]) * box.n_cells[1] * box.n_cells[2];
  return boxes.empty() ? double(fluid.pressure_map()->getGlobalNumElements()) : n;
}

/// In simulated time, or without an interval in parts of the run.
Schedule frame_schedule(const SceneOptions& options) {
  if (options.output.frame_interval)
    return {options.time.start, *options.output.frame_interval};
  return {0, 0.01};
}

/// Seconds of wall time after which a signal ends a step between its stages, without a checkpoint.
/// Batch systems kill 30 s after they have asked.
constexpr double long_step = 20;

/// Seconds of wall time between checkpoints that no interval is given for: as much as one loses to
/// a power cut without regret, and enough that writing them does not count.
constexpr double seconds_between_checkpoints = 600;

/// Returns the states of the lines of all models that have any.
template <int dim>
std::vector<LineState> line_states(const SolidSystem<dim>& solids) {
  std::vector<LineState> all;
  for (int m = 0; m < solids.n_models(); ++m) {
    if (const auto* output = solids.model(m).output()) {
      for (const LineState& line : output->line_states())
        all.push_back(line);
    }
  }
  return all;
}

/// Builds the plug-ins; throws InputError with their mistakes and those that the rest of the scene
/// has without them.
template <int dim>
Components<dim> build_parts(const Registries<dim>& registries, const ParameterList& scene,
                            const std::string& scene_file, const Communicator& comm) {
  Mistakes mistakes;
  Components<dim> components;
  mistakes.collect([&] { scene_options(scene); });
  mistakes.collect(
      [&] { components = build_components<dim>(registries, scene, scene_file, comm); });
  mistakes.collect(
      [&] { ObserverTables<dim>::check(registries.observers, scene.sublist("Observers")); });
  mistakes.throw_all();
  return components;
}

/// Thrown between the stages of a long step after a signal, on all ranks.
struct StepStopped {
  int signal;
};

}  // namespace

template <int dim>
Simulation<dim>::Simulation(const Registries<dim>& registries, const ParameterList& scene,
                            const RunOptions& options, const Communicator& comm, const Log& log)
    : scene_(scene),
      options_(options),
      comm_(comm),
      log_(log),
      components_(build_parts<dim>(registries, scene, options.scene_file, comm)),
      scene_options_(scene_options(scene)),
      tables_(comm, options.output_directory, components_.fluid->liquid(),
              components_.solids->joints() != nullptr, !line_states(*components_.solids).empty()),
      observers_(registries.observers, scene.sublist("Observers"), comm, options.output_directory,
                 scene_options_.time.start),
      frames_(comm, options.output_directory,
              {scene_options_.output.precision == "double" ? Precision::double_precision
                                                           : Precision::single_precision,
               0}),
      frame_times_(frame_schedule(scene_options_)),
      checkpoint_times_(scene_options_.time.start,
                        scene_options_.output.checkpoint_interval.value_or(0)),
      checkpoint_clock_(seconds_between_checkpoints) {
  if (options.end_time)
    scene_options_.time.end = *options.end_time;
  if (options.steps)
    scene_options_.time.most_steps = *options.steps;
  check_input(
      std::isfinite(scene_options_.time.end) && scene_options_.time.end > scene_options_.time.start,
      "--end-time {} s must be a number later than the start of the scene, {} s.",
      scene_options_.time.end, scene_options_.time.start);
  scene_options_.time.fixed_step = even_step(scene_options_.time);
  check_time_resolution(scene_options_.time);
  if (options.dump_system) {
    auto dumping =
        std::make_unique<DumpingStrategy>(std::move(components_.strategy), *options.dump_system);
    dumping_ = dumping.get();
    components_.strategy = std::move(dumping);
  }
  ScopedStage stage(timers_, "start");
  if (scene.sublist("Time").get<bool>("Settle") && options.restart_file.empty())
    settle<dim>(
        [&](const ParameterList& list) {
          return build_components<dim>(registries, list, options.scene_file, comm);
        },
        scene_, scene_options_, components_, log_);
  scene_options_.step.energy_budget = observers_.want_energy();
  scene_options_.step.prediction.surface_forces = observers_.want_forces();
  scheme_ = std::make_unique<TimeScheme<dim>>(components_, scene_options_.step,
                                              scene_options_.time.start, timers_);
  check_names();
  if (!observers_.empty())
    ObserverTables<dim>::try_out(registries.observers, scene.sublist("Observers"),
                                 view(components_.solids->states()));
}

/// Surfaces of fluid and solids lie side by side in frames.
template <int dim>
void Simulation<dim>::check_names() const {
  const auto* output = components_.fluid->output();
  if (!output)
    return;
  for (const std::string& name : output->surface_names())
    for (const SolidDescription& solid : scheme_->system().surface()->solids())
      check_input(
          xdmf::stored_name(solid.name) != name,
          "The solid \"{}\" has the name of the fluid's surface in frames; give it another.",
          solid.name);
}

template <int dim>
StepBound Simulation<dim>::next_step() {
  const TimeOptions& time = scene_options_.time;
  // A resting fluid still has to resolve moving solids.
  const double suggested =
      components_.fluid->suggested_step(time.cfl, largest_surface_speed(*components_.solids));
  const StepBound wanted = wanted_step(time, suggested);
  StepBound step = shorter(wanted, components_.fluid->largest_stable_step());
  step = shorter(step, largest_stable_step(*components_.solids));
  warnings_.before_step(step_ + 1, step, wanted, log_);
  // A bit of difference between ranks would let one of them take a step more.
  step.dt = min_all(comm_, step.dt);
  check_solve(scheme_->time() + step.dt > scheme_->time(),
              "The step of {} s at {} s is lost in the round-off of the time; something moves too "
              "fast, or a body is too stiff for explicit forces.",
              step.dt, scheme_->time());
  return shorter(step, {step_to_end(time, scheme_->time(), step.dt), "end of the run"});
}

template <int dim>
bool Simulation<dim>::finished() const {
  const TimeOptions& time = scene_options_.time;
  const double tiny = 1e-12 * std::max(std::abs(time.end), time.end - time.start);
  return scheme_->time() >= time.end - tiny || (time.most_steps > 0 && step_ >= time.most_steps);
}

template <int dim>
double Simulation<dim>::fraction_done() const {
  const TimeOptions& time = scene_options_.time;
  return part_of_run(time, scheme_->time() - time.start, step_);
}

template <int dim>
bool Simulation<dim>::reach_frame() {
  if (scene_options_.output.frame_interval)
    return frame_times_.reach(scheme_->time(), last_dt_);
  return frame_times_.reach(fraction_done(), part_of_run(scene_options_.time, last_dt_, 1));
}

template <int dim>
RunView<dim> Simulation<dim>::view(const std::vector<SolidState<dim>>& states) const {
  const bool has_energy = report_ && report_->energy;
  RunView<dim> run{scheme_->time(), last_dt_, *components_.fluid, states,
                   has_energy ? &*report_->energy : nullptr};
  for (int m = 0; m < components_.solids->n_models(); ++m)
    run.models.push_back(&components_.solids->model(m));
  if (report_ && report_->surface_forces)
    run.forces = &*report_->surface_forces;
  return run;
}

template <int dim>
Frame Simulation<dim>::frame() const {
  Frame frame;
  const auto* fluid = components_.fluid->output();
  if (fluid)
    fluid->add_frame(frame.boxes);
  frame.meshes = surface_frames<dim>(*components_.solids, *scheme_->system().surface());
  for (int m = 0; m < components_.solids->n_models(); ++m) {
    if (const auto* output = components_.solids->model(m).output())
      output->add_frames(frame.meshes);
  }
  if (fluid)
    fluid->add_surfaces(frame.meshes);
  return frame;
}

template <int dim>
void Simulation<dim>::write_frame() {
  ScopedStage stage(timers_, "frames");
  const Frame now = frame();
  frames_.write(step_, scheme_->time(), now.boxes, now.meshes);
}

template <int dim>
void Simulation<dim>::write_checkpoint() {
  ScopedStage stage(timers_, "checkpoints");
  CheckpointWriter checkpoint(comm_, options_.output_directory,
                              {step_, scheme_->time(), to_xml(scene_), files_});
  for_each_plug_in(components_, [&](const PlugIn& plug_in) { plug_in.save(checkpoint); });
  observers_.save(checkpoint);
  checkpoint.file().write_attribute("/", "last dt", last_dt_);
  checkpoint.file().write_attribute("/", "last frame", last_frame_);
  write_origin(checkpoint.file(), origin_);
  checkpoint.finish(scene_options_.output.keep_checkpoints);
}

template <int dim>
template <typename Function>
void Simulation<dim>::recorded(const Function& f) {
  check_input(!failed_, "This run has failed; open it again, from a checkpoint if there is one.");
  try {
    f();
  } catch (const std::exception& error) {
    failed_ = true;
    record_ending("failed", error.what());
    folder_lock_.reset();
    throw;
  }
}

template <int dim>
std::string Simulation<dim>::explain(bool takes_step) {
  const Frame now = frame();
  std::string text = explanation(components_, *scheme_, scene_options_) +
                     frames_row(scene_options_, stored_megabytes(now.boxes, now.meshes,
                                                                 scene_options_.output.precision));
  if (!takes_step)
    return text;
  const StepBound first = next_step();
  StepBound fast = first;
  const TimeOptions& time = scene_options_.time;
  if (time.fixed_step == 0) {
    const auto& fluid = *components_.fluid;
    const double fall = speed_of_fall(fluid), sides = speed_of_sides(fluid, time.start, time.end);
    const double suggested = fluid.suggested_step(time.cfl, std::max(fall, sides));
    fast = shorter(first, wanted_step(time, suggested));
    fast.reason = fall >= sides ? "what falls through the domain" : "the fastest inflow of the run";
  }
  const auto start = Clock::now();
  try {
    scheme_->advance(first.dt);
  } catch (const Failure& failure) {
    return text + fmt::format("{:<22} the first step fails: {}\n", "duration", failure.what());
  }
  return text + duration_row(time, first, fast, max_all(comm_, seconds_since(start)));
}

template <int dim>
int Simulation<dim>::run() {
  install_signal_handlers();  // begin() writes already
  begin();
  while (step()) {
  }
  end();
  return signal_ == 0 ? 0 : 128 + signal_;
}

template <int dim>
void Simulation<dim>::begin() {
  start_ = Clock::now();
  cpu_seconds_at_start_ = cpu_seconds();
  begin_outputs();
  recorded([&] { begin_tables(); });
}

template <int dim>
bool Simulation<dim>::take_step(double dt, Clock::time_point start) {
  ScopedStage stage(timers_, "step");
  try {
    report_ = scheme_->advance(dt, [&] {
      const int noted = seconds_since(start) > long_step ? noted_signal() : 0;
      const auto signal = static_cast<int>(max_all(comm_, static_cast<GlobalIndex>(noted)));
      if (signal != 0)
        throw StepStopped{signal};
    });
  } catch (const StepStopped& stopped) {
    signal_ = stopped.signal;
    is_within_step_ = true;
  }
  return !is_within_step_;
}

template <int dim>
bool Simulation<dim>::step() {
  if (finished() || signal_ != 0)
    return false;
  recorded([&] {
    const auto step_start = Clock::now();
    const StepBound next = next_step();
    if (!take_step(next.dt, step_start))
      return;
    ++step_;
    last_dt_ = next.dt;
    bound_of_step_ = next.reason;
    summary_.count(*report_);
    warnings_.after_step(step_, *report_, components_, log_);
    step_seconds_ = seconds_since(step_start);
    write_rows();
    write_what_is_due();
    signal_ = signal_received(comm_);
  });
  return !is_within_step_;
}

template <int dim>
void Simulation<dim>::write_rows() {
  const std::vector<SolidState<dim>> states = components_.solids->states();
  tables_.append(step_, *report_, states, step_seconds_);
  if (const ConstraintModel* joints = components_.solids->joints()) {
    const std::vector<JointState> coordinates = joints->states(report_->time);
    tables_.append_joints(step_, *report_, coordinates);
    summary_.count(coordinates);
  }
  if (const std::vector<LineState> lines = line_states(*components_.solids); !lines.empty())
    tables_.append_lines(step_, *report_, lines);
  if (!observers_.empty()) {
    ScopedStage stage(timers_, "observers");
    observers_.observe(step_, view(states), finished());
  }
  StepProgress progress = progress_of<dim>(step_, *report_, step_seconds_);
  progress.bound = bound_of_step_;
  progress.remaining_seconds =
      remaining_seconds(seconds_since(start_), fraction_at_begin_, fraction_done());
  log_.normal("{}", progress_line(progress));
}

template <int dim>
void Simulation<dim>::write_what_is_due() {
  const OutputOptions& output = scene_options_.output;
  const bool is_due = reach_frame() || frames_.n_frames() == 0;
  if (output.frames && is_due)
    last_frame_ = scheme_->time();
  if (output.frames && (is_due || finished()))
    write_frame();
  if (checkpoint_is_due())
    write_checkpoint();
}

template <int dim>
bool Simulation<dim>::checkpoint_is_due() {
  const std::optional<double>& interval = scene_options_.output.checkpoint_interval;
  if (!interval)
    return checkpoint_clock_.reach(comm_);
  return *interval > 0 && checkpoint_times_.reach(scheme_->time(), last_dt_);
}

template <int dim>
std::vector<std::pair<std::string, HistoryValue>> Simulation<dim>::history_row() const {
  if (!report_)
    return {};
  return tables_.history_row(step_, *report_, step_seconds_);
}

template <int dim>
void Simulation<dim>::end() {
  recorded([&] {
    if (!is_within_step_)
      write_checkpoint();
    end_outputs();
  });
  folder_lock_.reset();
}

template <int dim>
void Simulation<dim>::stop(const std::string& message) {
  if (failed_)
    return;
  if (comm_->getSize() == 1)
    recorded([&] { write_checkpoint(); });
  record_ending("stopped by an exception", message);
  folder_lock_.reset();
}

template <int dim>
void Simulation<dim>::end_outputs() {
  const FluidDiscretization<dim>& fluid = *components_.fluid;
  const RunFacts facts{signal_ == 0 ? "done" : "stopped by a signal",
                       step_ - first_step_,
                       step_,
                       scheme_->time(),
                       fluid.pressure_map()->getGlobalNumElements(),
                       n_cells(fluid),
                       fluid.smallest_length(),
                       components_.solids->n_unknowns(),
                       seconds_since(start_),
                       cpu_seconds() - cpu_seconds_at_start_};
  write_summary(comm_, options_.output_directory,
                summary_.json(header_, facts, timers_.report(comm_), comm_));
  log_.normal("{}", timing_table(timers_.report(comm_)));
  if (dumping_ && !dumping_->has_written())
    log_.warning("--dump-system: no step solved {}:{}, and '{}' is not written.",
                 options_.dump_system->step, options_.dump_system->solve,
                 options_.dump_system->file);
  if (is_within_step_) {
    log_.normal(
        "Stopped by signal {} within step {}, which takes longer than {} s and is lost; the "
        "last checkpoint continues the run.",
        signal_, step_ + 1, long_step);
  } else if (signal_ != 0) {
    log_.normal("Stopped by signal {} after step {}; the checkpoint in {} continues the run.",
                signal_, step_, options_.output_directory);
  }
}

template <int dim>
void Simulation<dim>::record_ending(const std::string& status,
                                    const std::string& message) const noexcept {
  if (!is_root(comm_))
    return;
  try {
    write_file_atomically(options_.output_directory + "/summary.json",
                          summary_text(unfinished_summary(status, message, header_)));
  } catch (const std::exception&) {
    // The failure has its own message; a full disk may hold no other.
  }
}

template class Simulation<2>;
template class Simulation<3>;

}  // namespace lockstep
