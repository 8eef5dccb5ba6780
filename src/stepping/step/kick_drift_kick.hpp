#pragma once
#include "stepping/step/time_scheme.hpp"

namespace lockstep {

/// A scheme of second order for rigid solids and the fluid around them: both of the coupled solves
/// are kept, each half of the step's forces where the bodies then are. The same solves as those of
/// PaperStep, but for F2, which finds nothing to do where bodies go on as the first solve has it.
template <int dim>
class KickDriftKick : public TimeScheme<dim> {
 public:
  using TimeScheme<dim>::advance;
  /// See TimeScheme. Throws InputError for deforming solids, joints and trapped gas besides.
  KickDriftKick(Components<dim>& components, const StepOptions& options, double start_time,
                StageTimers& timers);

  StepReport<dim> advance(double dt, const std::function<void()>& between_stages) override;

 private:
  StageResults<dim> kick(const StepContext<dim>& context);
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
