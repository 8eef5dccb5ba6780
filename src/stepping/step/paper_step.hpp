#pragma once
#include "stepping/step/time_scheme.hpp"

namespace lockstep {

/// The scheme of time of Section 7, of first order: solids are moved by what a first solve finds,
/// which is thrown away; a second one finds velocities.
template <int dim>
class PaperStep : public TimeScheme<dim> {
 public:
  using TimeScheme<dim>::advance;
  /// See TimeScheme.
  PaperStep(Components<dim>& components, const StepOptions& options, double start_time,
            StageTimers& timers)
      : TimeScheme<dim>(components, options, start_time, timers) {}

  StepReport<dim> advance(double dt, const std::function<void()>& between_stages) override;

 private:
  StepContext<dim> positions(const StepTime& step) const;
  StepContext<dim> velocities(const StepTime& step, const StartImpulse& joints) const;
  using TimeScheme<dim>::components_;
  using TimeScheme<dim>::transport_;
  using TimeScheme<dim>::solve_;
  using TimeScheme<dim>::prediction_;
  using TimeScheme<dim>::solid_forces_;
  using TimeScheme<dim>::positions_;
  using TimeScheme<dim>::advection_;
  using TimeScheme<dim>::audit_;
  using TimeScheme<dim>::timers_;
  using TimeScheme<dim>::time_;
  using TimeScheme<dim>::last_dt_;
  using TimeScheme<dim>::n_steps_;
};

}  // namespace lockstep
