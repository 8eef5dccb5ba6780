#include "stepping/step/time_scheme.hpp"

#include "base/errors.hpp"
#include "stepping/step/kick_drift_kick.hpp"
#include "stepping/step/paper_step.hpp"

namespace lockstep {

namespace {
/// Throws InputError if what is prescribed at the start of a run has no solution. Collective.
template <int dim>
void check_start(const Components<dim>& components, const CoupledSystem<dim>& system, double time) {
  // Motions that begin at rest do so but for round-off.
  const double negligible = 1e-12 * components.fluid->fluid_volume();  // a second
  std::string impossible =
      system.impossible_flow(time, components.solids->constraints(time, time), negligible);
  if (impossible.empty())
    impossible = system.squeezing_flow(time, negligible);
  check_input(impossible.empty(), "At the start: {}", impossible);
}
}  // namespace

template <int dim>
StepParts<dim>::StepParts(Components<dim>& plug_ins, const StepOptions& options, double start_time,
                          StageTimers& stage_timers)
    : components(plug_ins),
      system(*components.fluid, *components.solids, *components.coupling),
      transport(components, system, stage_timers),
      solve(components, system, options.solve, stage_timers),
      prediction(components, system, solve, options.prediction, stage_timers),
      solid_forces(components, system),
      positions(components, system, solve, stage_timers),
      advection(components, system, options.solve.tolerance),
      audit(components, system, options.energy_budget, options.prediction.surface_forces),
      timers(stage_timers) {
  transport.freeze();
  audit.start(start_time);
  check_start(components, system, start_time);
}

template <int dim>
bool StepParts<dim>::begin(const StepTime& step) {
  const Point<dim> last_gravity = components.fluid->gravity();
  const bool has_moved = transport.make_room(step);
  const Point<dim> gravity = components.fluid->gravity();
  components.solids->set_gravity(gravity);
  const bool has_other_unknowns = components.solids->begin_step(step.begin, step.dt);
  const bool has_other_loads = components.solids->has_unknowns() && gravity != last_gravity;
  if (has_other_unknowns || has_other_loads) {  // hydrostatic forces are frozen, too
    transport.freeze();
    audit.start(step.begin);
  }
  if (components.contact)
    components.contact->begin_step(step.begin);
  audit.begin(step);
  return has_moved;
}

template <int dim>
StepReport<dim> StepParts<dim>::finish(const StepContext<dim>& context,
                                       const StageResults<dim>& stages) {
  StepReport<dim> report = audit.report(context, stages);
  solve.project(stages.end.solution, stages.friction.pressure);
  audit.end_projection(context, stages, report);
  solve.accept(context, stages.end, report.reactions);
  audit.close(context, stages.end.solution, report);
  return report;
}

namespace {
/// True if steps are to be of second order. Throws InputError if they cannot, but are asked to.
template <int dim>
bool takes_second_order(const Components<dim>& components, int order) {
  if (order == 1 || !components.solids->has_unknowns())
    return false;
  const std::string hindrance = hindrance_to_kick_drift_kick(components);
  check_input(order != 2 || hindrance.empty(),
              "{}; set \"Time/Order in Time\" to 1, or leave it out.", hindrance);
  return hindrance.empty();
}
}  // namespace

template <int dim>
TimeScheme<dim>::TimeScheme(Components<dim>& components, const StepOptions& options,
                            double start_time, StageTimers& timers)
    : parts_(components, options, start_time, timers),
      is_of_second_order_(takes_second_order(components, options.order)),
      time_(start_time) {
  if (!is_of_second_order_)
    return;
  components.fluid->take_kicks();
  components.solids->take_kicks();
}

template <int dim>
StepReport<dim> TimeScheme<dim>::advance(double dt, const std::function<void()>& between_stages) {
  const StepTime step{time_, dt, last_dt_, n_steps_ + 1};
  const StageRunner run(between_stages, parts_.timers);
  const StepReport<dim> report =
      is_of_second_order_ ? kick_drift_kick(parts_, step, run) : paper_step(parts_, step, run);
  time_ = step.end();
  last_dt_ = dt;
  ++n_steps_;
  return report;
}

template <int dim>
void TimeScheme<dim>::resume(double time, long long n_steps, double last_dt) {
  time_ = time;
  n_steps_ = n_steps;
  last_dt_ = last_dt;
  parts_.components.solids->begin_step(time, 0);
  parts_.transport.freeze();
  parts_.audit.start(time);
}

template struct StepParts<2>;
template struct StepParts<3>;
template class TimeScheme<2>;
template class TimeScheme<3>;

}  // namespace lockstep
