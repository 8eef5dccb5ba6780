// S1: where the solids go.
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>

#include "coupling/swept_volumes.hpp"
#include "interfaces/free_flight.hpp"
#include "stepping/stepper.hpp"

namespace lockstep {

/// V^{n+1/2}: soft solids keep the volumes of closed regions, contact acts. With joints also the
/// impulses that these give. `solution`: where the solve begins, empty at the last step's, and what
/// it finds.
template <int dim>
RCP<Vector> Stepper<dim>::find_motion(const StepContext<dim>& context,
                                      const Prediction<dim>& prediction, BlockVector& solution,
                                      StepReport<dim>& report) {
  auto& solids = *components_.solids;
  const double dt = context.step_dt;
  RCP<Vector> half_velocity = make_vector(solids.map());
  SweptRates swept;
  RCP<Vector> momentum;
  if (coupled()) {
    ScopedPhase phase(timers_, "S1");
    momentum = solid_momentum(context, prediction, report);
    const CoupledSolution found =
        solve_newton(context, momentum, report.s1, report.incompatibility_s1,
                     solution.pressure.is_null() ? nullptr : &solution);
    solution = found.unknowns;
    half_velocity = found.velocity;
    if (solids.joints())
      start_impulse_ = system_.reactions(context.dt, context.constraints, *momentum,
                                         {solution.pressure, half_velocity});
    swept = swept_rates(*components_.fluid, solids, *components_.coupling, *half_velocity);
  }
  ScopedPhase phase(timers_, "solid motion");
  solids.limit_motion(dt, *half_velocity);
  report.stretch_beyond_limit = solids.stretch_beyond_limit();
  // Shells push the fluid of closed regions, bodies only take back what straight steps add.
  const auto sweep_shells = [&](Vector& velocity) {
    sweep_volumes(rates_of_kind(swept, solids, false), solids, dt, velocity);
  };
  sweep_shells(*half_velocity);
  const Vector as_solved(*half_velocity, Teuchos::Copy);
  sweep_volumes(rates_of_kind(swept, solids, true), solids, dt, *half_velocity);
  if (coupled() && solids.has_implicit_forces())
    bound_sweep<dim>(solids, context.dt, as_solved, *half_velocity);
  if (coupled() && solids.has_implicit_forces()) {
    const SettledMotion<dim> settled =
        settle_motion<dim>(solids, components_.contact.get(), context, sweep_shells, as_solved,
                           *half_velocity, *momentum);
    if (settled.linearised_anew)
      system_.forget_solid_block();
    half_velocity = settled.velocity;
    report.contact_position = settled.contact;
  } else if (components_.contact && coupled()) {
    report.contact_position = components_.contact->resolve(
        solids, ContactPhase::position, dt, *half_velocity, contact_response(context.dt));
  }
  return half_velocity;
}

/// Velocities that joints let take bodies off them by O(dt^2) all the same. Closing finds what
/// brings them back, by the bodies' own masses; the solve about that knows the mass of the fluid,
/// and what is still left to close is of higher order. How bodies turn on the way depends on the
/// impulses at its begin, so that the correction of S1 is found with them.
template <int dim>
void Stepper<dim>::close_joints(StepContext<dim> context, const Prediction<dim>& prediction,
                                BlockVector& solution, RCP<Vector>& velocity,
                                StepReport<dim>& report) {
  auto& solids = *components_.solids;
  const double end = context.time + context.step_dt;
  auto* const flights = dynamic_cast<FreeFlight*>(solids.joints());
  const auto close = [&]() -> ClosedFlight {
    // Solutions may share it.
    velocity = rcp(new Vector(*velocity, Teuchos::Copy));
    if (flights)
      return flights->close_flight(context.time, context.step_dt, *midpoint_correction_,
                                   report.contact_position.n_contacts > 0, *velocity);
    return {solids.joints()->close(context.time, context.step_dt, *velocity), Teuchos::null,
            Teuchos::null};
  };
  ClosedFlight motion = close();
  if (!motion.drift.is_null()) {
    const SolveReport earlier = report.s1;
    context.constraints = solids.constraints(context.time, end, motion.drift);
    if (!motion.correction.is_null()) {
      correction_change_ = motion.correction;
      correction_change_->update(-1, *midpoint_correction_, 1);
    }
    velocity = find_motion(context, prediction, solution, report);
    report.s1.add_work(earlier);
    motion = close();
  }
  held_at_start_ = Teuchos::null;
  if (motion.drift.is_null()) {
    start_impulse_ = Teuchos::null;
    return;
  }
  held_at_start_ = solids.reduction().on_given(*start_impulse_);
  solids.reduction().drop_given(*start_impulse_);
  if (!motion.later_impulse.is_null())
    start_impulse_->update(1, *motion.later_impulse, 1);
}

/// All solids go to their positions at t^{n+1}.
template <int dim>
void Stepper<dim>::move_solids(const StepContext<dim>& context, const Prediction<dim>& prediction,
                               StepReport<dim>& report) {
  auto& solids = *components_.solids;
  start_impulse_ = Teuchos::null;
  correction_change_ = Teuchos::null;
  BlockVector solution;
  RCP<Vector> velocity = find_motion(context, prediction, solution, report);
  if (coupled() && solids.joints())
    close_joints(context, prediction, solution, velocity, report);
  correction_change_ = Teuchos::null;
  ScopedPhase phase(timers_, "solid motion");
  solids.move(*velocity, context.time, context.step_dt);
}

template void Stepper<2>::move_solids(const StepContext<2>&, const Prediction<2>&, StepReport<2>&);
template void Stepper<3>::move_solids(const StepContext<3>&, const Prediction<3>&, StepReport<3>&);

}  // namespace lockstep
