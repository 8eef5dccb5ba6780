#pragma once
#include <functional>

#include "stepping/step/fluid_transport.hpp"
#include "stepping/step/step_audit.hpp"

namespace lockstep {

struct StepOptions {
  /// Order in time: 1 is `paper_step`, 2 `kick_drift_kick`, 0 that where it can be had.
  int order = 1;
  CoupledSolveOptions solve;  ///< its tolerance is that of F2, too
  PredictionOptions prediction;
  bool energy_budget = false;  ///< reports have it
};

/// The collaborators of a step, which do not know the script that calls them.
template <int dim>
struct StepParts {
  /// Freezes the geometry of the start. Throws InputError for plug-ins that do not fit together and
  /// for prescribed motions without a solution. Collective.
  StepParts(Components<dim>& plug_ins, const StepOptions& options, double start_time,
            StageTimers& stage_timers);

  /// Fluid, solids and contact begin a step; true if the fluid is on other cells than before.
  bool begin(const StepTime& step);
  /// Pressure and velocities that were found over `context` act on fluid and solids. Returns the
  /// report, whose books are closed.
  StepReport<dim> finish(const StepContext<dim>& context, const StageResults<dim>& stages);

  Components<dim>& components;
  CoupledSystem<dim> system;
  FluidTransport<dim> transport;
  CoupledSolve<dim> solve;
  Prediction<dim> prediction;
  SolidForces<dim> solid_forces;
  PositionUpdate<dim> positions;
  AdvectionVelocity<dim> advection;
  StepAudit<dim> audit;
  StageTimers& timers;
};

/// Runs the stages of a step one after another: times each, and lets the caller look in between.
class StageRunner {
 public:
  StageRunner(const std::function<void()>& between_stages, StageTimers& timers)
      : between_stages_(between_stages), timers_(timers) {}

  void pause() const { between_stages_(); }
  template <typename Stage>
  auto operator()(const std::string& name, const Stage& stage) const {
    pause();
    const ScopedStage timed(timers_, name);
    return stage();
  }

 private:
  const std::function<void()>& between_stages_;
  StageTimers& timers_;
};

/// A scheme of time: carries fluid and solids from step to step by one of the scripts.
template <int dim>
class TimeScheme {
 public:
  /// Makes its StepParts; where nothing is free to move the order is 1. Throws InputError for
  /// scenes that an order does not know. Collective.
  TimeScheme(Components<dim>& components, const StepOptions& options, double start_time,
             StageTimers& timers);

  /// Advances by dt. Throws SolveError if a solve fails, or if what is prescribed has no solution.
  /// `between_stages` is called between the stages; once it has thrown, fluid and solids are
  /// somewhere within the step, and of no use. Collective.
  StepReport<dim> advance(
      double dt, const std::function<void()>& between_stages = [] {});
  double time() const { return time_; }  ///< [s]
  /// For restart, after fluid and solids were loaded: freezes the geometry anew. `last_dt`: length
  /// of the last of the `n_steps` [s]. Collective.
  void resume(double time, long long n_steps, double last_dt);
  CoupledSystem<dim>& system() { return parts_.system; }

 private:
  StepParts<dim> parts_;
  bool is_of_second_order_;
  double time_;
  double last_dt_ = 0;     ///< 0 before the first step [s]
  long long n_steps_ = 0;  ///< taken
};

}  // namespace lockstep
