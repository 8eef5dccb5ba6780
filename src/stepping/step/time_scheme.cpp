#include "stepping/step/time_scheme.hpp"

#include "stepping/step/kick_drift_kick.hpp"
#include "stepping/step/paper_step.hpp"

namespace lockstep {

template <int dim>
TimeScheme<dim>::TimeScheme(Components<dim>& components, const StepOptions& options,
                            double start_time, StageTimers& timers)
    : components_(components),
      system_(*components.fluid, *components.solids, *components.coupling),
      transport_(components, system_, timers),
      solve_(components, system_, options.solve, timers),
      prediction_(components, system_, solve_, options.prediction, timers),
      solid_forces_(components, system_),
      positions_(components, system_, solve_, timers),
      advection_(components, system_, options.solve.tolerance),
      audit_(components, system_, options.energy_budget),
      timers_(timers),
      time_(start_time) {
  transport_.freeze();
  audit_.start(time_);
  solve_.check_start(time_);
}

template <int dim>
bool TimeScheme<dim>::begin(const StepTime& step) {
  const bool has_moved = transport_.make_room(step);
  components_.solids->set_gravity(components_.fluid->gravity());
  if (components_.solids->begin_step(step.begin, step.dt)) {  // other dofs are unknowns now
    transport_.freeze();
    audit_.start(step.begin);
  }
  if (components_.contact)
    components_.contact->begin_step(step.begin);
  audit_.begin(step);
  return has_moved;
}

template <int dim>
StepReport<dim> TimeScheme<dim>::finish(const StepContext<dim>& context,
                                        const StageResults<dim>& stages) {
  StepReport<dim> report = audit_.report(context, stages);
  solve_.project(stages.end.solution, stages.friction.pressure);
  audit_.end_projection(context, stages, report);
  solve_.accept(context, stages.end, report.reactions);
  audit_.close(context, stages.end.solution, report);
  return report;
}

template <int dim>
void TimeScheme<dim>::end(const StepTime& step) {
  time_ = step.end();
  last_dt_ = step.dt;
  ++n_steps_;
}

template <int dim>
void TimeScheme<dim>::resume(double time, long long n_steps, double last_dt) {
  time_ = time;
  n_steps_ = n_steps;
  last_dt_ = last_dt;
  components_.solids->begin_step(time, 0);
  transport_.freeze();
  audit_.start(time);
}

template <int dim>
std::unique_ptr<TimeScheme<dim>> make_time_scheme(int order, Components<dim>& components,
                                                  const StepOptions& options, double start_time,
                                                  StageTimers& timers) {
  if (order == 2 && components.solids->has_unknowns())
    return std::make_unique<KickDriftKick<dim>>(components, options, start_time, timers);
  return std::make_unique<PaperStep<dim>>(components, options, start_time, timers);
}

template class TimeScheme<2>;
template class TimeScheme<3>;
template std::unique_ptr<TimeScheme<2>> make_time_scheme(int, Components<2>&, const StepOptions&,
                                                         double, StageTimers&);
template std::unique_ptr<TimeScheme<3>> make_time_scheme(int, Components<3>&, const StepOptions&,
                                                         double, StageTimers&);

}  // namespace lockstep
