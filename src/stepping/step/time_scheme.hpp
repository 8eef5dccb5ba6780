#pragma once
#include <functional>

#include "stepping/step/fluid_transport.hpp"
#include "stepping/step/step_audit.hpp"

namespace lockstep {

struct StepOptions {
  CoupledSolveOptions solve;  ///< its tolerance is that of F2, too
  PredictionOptions prediction;
  bool energy_budget = false;  ///< reports have it
};

/// A scheme of time: a script on collaborators that do not know it. Schemes differ in `advance`.
template <int dim>
class TimeScheme {
 public:
  virtual ~TimeScheme() = default;
  TimeScheme(const TimeScheme&) = delete;
  TimeScheme& operator=(const TimeScheme&) = delete;

  /// Advances by dt. Throws SolveError if a solve fails, or if what is prescribed has no solution.
  /// `between_stages` is called between the stages; once it has thrown, fluid and solids are
  /// somewhere within the step, and of no use. Collective.
  virtual StepReport<dim> advance(double dt, const std::function<void()>& between_stages) = 0;
  StepReport<dim> advance(double dt) {
    return advance(dt, [] {});
  }
  double time() const { return time_; }  ///< [s]
  /// For restart, after fluid and solids were loaded: freezes the geometry anew. `last_dt`: length
  /// of the last of the `n_steps` [s]. Collective.
  void resume(double time, long long n_steps, double last_dt);
  CoupledSystem<dim>& system() { return system_; }

 protected:
  /// Freezes the geometry of the start. Throws InputError for plug-ins that do not fit together and
  /// for prescribed motions without a solution. Collective.
  TimeScheme(Components<dim>& components, const StepOptions& options, double start_time,
             StageTimers& timers);

  /// Fluid, solids and contact begin a step; true if the fluid is on other cells than before.
  bool begin(const StepTime& step);
  /// Pressure and velocities that were found over `context` act on fluid and solids.
  /// Returns the report, whose books are closed.
  StepReport<dim> finish(const StepContext<dim>& context, const StageResults<dim>& stages);
  void end(const StepTime& step);

  Components<dim>& components_;
  CoupledSystem<dim> system_;
  FluidTransport<dim> transport_;
  CoupledSolve<dim> solve_;
  Prediction<dim> prediction_;
  SolidForces<dim> solid_forces_;
  PositionUpdate<dim> positions_;
  AdvectionVelocity<dim> advection_;
  StepAudit<dim> audit_;
  StageTimers& timers_;
  double time_;
  double last_dt_ = 0;     ///< 0 before the first step [s]
  long long n_steps_ = 0;  ///< taken
};

/// `Time/Order in Time`: 1 is PaperStep, 2 KickDriftKick, or PaperStep where nothing is free to
/// move. As their constructors. Collective.
template <int dim>
std::unique_ptr<TimeScheme<dim>> make_time_scheme(int order, Components<dim>& components,
                                                  const StepOptions& options, double start_time,
                                                  StageTimers& timers);

}  // namespace lockstep
