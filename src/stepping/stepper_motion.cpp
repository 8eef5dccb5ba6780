// S1: where the solids go.
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>

#include "coupling/swept_volumes.hpp"
#include "interfaces/free_flight.hpp"
#include "linear/matrix_rows.hpp"
#include "linear/overlap.hpp"
#include "stepping/stepper.hpp"

namespace lockstep {

namespace {

/// q := q without what acts on marked dofs, and on combinations of them.
void drop_with_followers(const Reduction& reduction, const Vector& marks, Vector& momentum) {
  Vector dropped(marks, Teuchos::Copy);
  if (reduction.has_combinations()) {
    const CrsMatrix& combinations = *reduction.combinations();
    const RCP<const Vector> terms = on_columns(combinations, marks);
    const auto is_marked = terms->getData();
    const auto values = dropped.getDataNonConst();
    for_each_entry(combinations, [&](int row, GlobalIndex column, double) {
      if (is_marked[combinations.getColMap()->getLocalElement(column)] != 0)
        values[row] = 1;
    });
  }
  const auto drop = dropped.getData();
  const auto values = momentum.getDataNonConst();
  for (int row = 0; row < drop.size(); ++row) {
    if (drop[row] != 0)
      values[row] = 0;
  }
}

}  // namespace

/// V^{n+1/2}: soft solids keep the volumes of closed regions, contact acts. With joints also the
/// impulses that these give. `correction`: see `solid_momentum`. `solution`: where the solve
/// begins, empty at the last step's, and what it finds.
template <int dim>
typename Stepper<dim>::FoundMotion Stepper<dim>::find_motion(const StepContext<dim>& context,
                                                             const Prediction<dim>& prediction,
                                                             const RCP<const Vector>& correction,
                                                             BlockVector& solution,
                                                             StepReport<dim>& report) {
  auto& solids = *components_.solids;
  const double dt = context.step_dt;
  RCP<Vector> half_velocity = make_vector(solids.map());
  SweptRates swept;
  RCP<Vector> momentum, joint_impulse;
  if (coupled()) {
    ScopedStage stage(timers_, "S1");
    momentum = solid_momentum(context, prediction, report, correction);
    const CoupledSolution found =
        solve_newton(context, momentum, report.s1, report.incompatibility_s1,
                     solution.pressure.is_null() ? nullptr : &solution);
    solution = found.unknowns;
    half_velocity = found.velocity;
    if (solids.joints()) {
      Vector given(*momentum, Teuchos::Copy);
      if (!found.gas_momentum.is_null())
        given.update(1, *found.gas_momentum, 1);
      joint_impulse = system_.reactions(context.dt, context.constraints, given,
                                        {solution.pressure, half_velocity});
    }
    swept = swept_rates(*components_.fluid, solids, *components_.coupling, *half_velocity);
  }
  ScopedStage stage(timers_, "solid motion");
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
  RCP<const Vector> before_contact;
  if (solids.joints())
    before_contact = rcp(new Vector(*half_velocity, Teuchos::Copy));
  if (coupled() && solids.has_implicit_forces()) {
    const SettledMotion<dim> settled =
        settle_motion<dim>(solids, components_.contact.get(), context, sweep_shells, as_solved,
                           *half_velocity, *momentum);
    half_velocity = settled.velocity;
    report.is_settled = report.is_settled && settled.is_settled;
    report.contact_position = settled.contact;
  } else if (components_.contact && coupled()) {
    report.contact_position = components_.contact->resolve(
        solids, ContactPhase::position, dt, *half_velocity, contact_response(context.dt));
  }
  return {half_velocity, before_contact, joint_impulse};
}

/// Velocities that joints let take bodies off them by O(dt^2) all the same. Closing finds what
/// brings them back, by the bodies' own masses; the solve about that knows the mass of the fluid,
/// and what is still left to close is of higher order. How bodies turn on the way depends on the
/// impulses at its begin, so that the correction of S1 is found with them.
template <int dim>
StartImpulse Stepper<dim>::close_joints(StepContext<dim> context, const Prediction<dim>& prediction,
                                        const RCP<const Vector>& correction, BlockVector& solution,
                                        FoundMotion& found, StepReport<dim>& report) {
  auto& solids = *components_.solids;
  const double end = context.time + context.step_dt;
  auto* const flights = side_of<FreeFlight>(*solids.joints());
  const auto close = [&](const Vector& with) -> ClosedFlight {
    // Solutions may share it.
    found.velocity = rcp(new Vector(*found.velocity, Teuchos::Copy));
    if (flights)
      return flights->close_flight(context.time, context.step_dt, with, *found.solved,
                                   *found.velocity);
    ClosedFlight motion;
    motion.drift = solids.joints()->close(context.time, context.step_dt, *found.velocity).drift;
    return motion;
  };
  ClosedFlight motion = close(*correction);
  if (!motion.drift.is_null()) {
    const SolveReport earlier = report.s1;
    context.constraints = solids.constraints(context.time, end, motion.drift);
    RCP<const Vector> next = correction;
    if (!motion.correction.is_null())
      next = motion.correction;
    found = find_motion(context, prediction, next, solution, report);
    report.s1.add_work(earlier);
    motion = close(*next);
  }
  if (motion.drift.is_null())
    return {};
  const RCP<Vector> impulse = found.joint_impulse;
  if (!motion.at_end.is_null())
    drop_with_followers(solids.reduction(), *motion.at_end, *impulse);
  const RCP<const Vector> held = solids.reduction().on_given(*impulse);
  solids.reduction().drop_given(*impulse);
  if (!motion.later_impulse.is_null())
    impulse->update(1, *motion.later_impulse, 1);
  return {impulse, held};
}

/// All solids go to their positions at t^{n+1}.
template <int dim>
StartImpulse Stepper<dim>::move_solids(const StepContext<dim>& context,
                                       const Prediction<dim>& prediction, StepReport<dim>& report) {
  auto& solids = *components_.solids;
  const bool jointed = coupled() && solids.joints();
  RCP<const Vector> correction;
  if (jointed)
    correction = midpoint_correction(context.dt);
  BlockVector solution;
  FoundMotion found = find_motion(context, prediction, correction, solution, report);
  StartImpulse joints;
  if (jointed)
    joints = close_joints(context, prediction, correction, solution, found, report);
  ScopedStage stage(timers_, "solid motion");
  solids.move(*found.velocity, context.time, context.step_dt);
  return joints;
}

template StartImpulse Stepper<2>::move_solids(const StepContext<2>&, const Prediction<2>&,
                                              StepReport<2>&);
template StartImpulse Stepper<3>::move_solids(const StepContext<3>&, const Prediction<3>&,
                                              StepReport<3>&);

}  // namespace lockstep
