#include "stepping/step/position_update.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>

#include "coupling/solid_totals.hpp"
#include "linear/matrix_rows.hpp"
#include "linear/overlap.hpp"

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

/// Adds what contact did to the velocities of a solve to what that held.
template <int dim>
void add_last(const ContactReport<dim>& last, ContactReport<dim>& contact) {
  contact.n_contacts = std::max(contact.n_contacts, last.n_contacts);
  contact.iterations += last.iterations;
  contact.n_crossings = last.n_crossings;
  contact.deepest_overlap = std::max(contact.deepest_overlap, last.deepest_overlap);
}

}  // namespace

template <int dim>
PositionUpdate<dim>::PositionUpdate(Components<dim>& components, CoupledSystem<dim>& system,
                                    CoupledSolve<dim>& solve, StageTimers& timers)
    : components_(components),
      system_(system),
      solve_(solve),
      solid_forces_(components, system),
      timers_(timers) {}

/// The coupled solve, the rates at which it has soft solids sweep volumes, and with joints the
/// impulses that these give.
template <int dim>
void PositionUpdate<dim>::solve(const StepContext<dim>& context, const RCP<const Vector>& drag,
                                const RCP<const Vector>& correction, const BlockVector* nearby,
                                Found& found) {
  ScopedStage stage(timers_, context.solve);
  const auto& solids = *components_.solids;
  const RCP<Vector> momentum = solid_forces_.momentum(context, correction).momentum;
  if (!drag.is_null())
    momentum->update(1, *drag, 1);
  MotionWithContacts<dim> held;
  if (solve_.holds_contacts())
    held = solve_.converge_with_contacts(context, momentum, nearby);
  found.holds_contacts = solve_.holds_contacts() && held.is_settled;
  if (found.holds_contacts) {
    found.solution = held.solution;
    found.path.contact = held.contact;
  } else {
    found.solution = solve_.converge(context, momentum, nearby);
    found.solution.report.add_work(held.solution.report);
    found.path.contact.n_solves = held.contact.n_solves;
    found.path.contact.residual = held.contact.residual;
    held = {};
  }
  found.velocity = found.solution.velocity;
  found.path.report = found.solution.report;
  found.path.incompatibility = found.solution.incompatibility;
  if (solids.joints()) {
    Vector given(*found.solution.momentum, Teuchos::Copy);
    if (!found.solution.gas_momentum.is_null())
      given.update(1, *found.solution.gas_momentum, 1);
    found.joint_impulse = system_.reactions(context.dt, context.constraints, given,
                                            {found.solution.unknowns.pressure, found.velocity});
    if (!held.contact.held.empty()) {
      found.joint_impulse->update(-1, *solve_.reactions_to_contacts(context, held), 1);
      found.solved = held.free_velocity;
    }
  }
  found.swept = swept_rates(*components_.fluid, solids, *components_.coupling, *found.velocity);
}

/// Limits of strain, volumes of closed regions, contacts.
template <int dim>
void PositionUpdate<dim>::keep_limits(const StepContext<dim>& context, Found& found) {
  auto& solids = *components_.solids;
  const double dt = context.step.dt;
  const bool is_implicit = solids.has_unknowns() && has_implicit_forces(solids);
  solids.limit_motion(dt, *found.velocity);
  found.path.stretch_beyond_limit = stretch_beyond_limit(solids);
  // Shells push the fluid of closed regions, bodies only take back what straight steps add.
  const auto sweep_shells = [&](Vector& velocity) {
    sweep_volumes(rates_of_kind(found.swept, solids, false), solids, dt, velocity);
  };
  sweep_shells(*found.velocity);
  const Vector as_solved(*found.velocity, Teuchos::Copy);
  sweep_volumes(rates_of_kind(found.swept, solids, true), solids, dt, *found.velocity);
  if (is_implicit)
    bound_sweep<dim>(solids, context.dt, as_solved, *found.velocity);
  if (solids.joints() && found.solved.is_null())
    found.solved = rcp(new Vector(*found.velocity, Teuchos::Copy));
  if (is_implicit) {
    const SettledMotion<dim> settled =
        settle_motion<dim>(solids, components_.contact.get(), context,
                           {as_solved, *found.velocity, sweep_shells}, *found.solution.momentum);
    found.velocity = settled.velocity;
    found.path.is_converged = settled.is_settled;
    add_last(settled.contact, found.path.contact);
  } else if (components_.contact && solids.has_unknowns() &&
             (!found.holds_contacts || has_soft_solids(*components_.solids))) {
    add_last(components_.contact->resolve(solids, ContactPhase::position, dt, *found.velocity,
                                          joint_response<dim>(solids, context.dt)),
             found.path.contact);
    if (!found.holds_contacts)
      found.path.contact.n_outside = found.path.contact.n_contacts > 0 ? 1 : 0;
  }
}

/// `correction`: see `SolidForces::momentum`; `nearby`: see `CoupledSolve::solve`.
template <int dim>
typename PositionUpdate<dim>::Found PositionUpdate<dim>::find_once(
    const StepContext<dim>& context, const RCP<const Vector>& drag,
    const RCP<const Vector>& correction, const BlockVector* nearby) {
  Found found;
  if (components_.solids->has_unknowns())
    solve(context, drag, correction, nearby, found);
  else
    found.velocity = make_vector(components_.solids->map());
  ScopedStage stage(timers_, "solid motion");
  keep_limits(context, found);
  found.path.velocity = found.velocity;
  return found;
}

/// Velocities that joints let take bodies off them by O(dt^2) all the same. Closing finds what
/// brings them back, by the bodies' own masses; the solve about that knows the mass of the fluid,
/// and what is still left to close is of higher order. How bodies turn on the way depends on the
/// impulses at its begin, so that the midpoint correction is found with them.
template <int dim>
SolidPath<dim> PositionUpdate<dim>::find_with_joints(StepContext<dim> context,
                                                     const RCP<const Vector>& drag) {
  auto& solids = *components_.solids;
  const auto close = [&](const Vector& correction, Found& found) {
    // Solutions may share it.
    found.velocity = rcp(new Vector(*found.velocity, Teuchos::Copy));
    found.path.velocity = found.velocity;
    return solids.joints()->close(context.step.begin, context.step.dt, correction, *found.solved,
                                  *found.velocity);
  };
  const RCP<const Vector> correction = solid_forces_.midpoint_correction(context.dt);
  Found found = find_once(context, drag, correction, nullptr);
  ClosedMotion motion = close(*correction, found);
  if (!motion.constraint_error.is_null()) {
    const Found first = found;
    context.constraints =
        solids.constraints(context.step.begin, context.step.end(), motion.constraint_error);
    RCP<const Vector> next = correction;
    if (!motion.correction.is_null())
      next = motion.correction;
    found = find_once(context, drag, next, &first.solution.unknowns);
    found.path.report.add_work(first.path.report);
    found.path.is_converged = found.path.is_converged && first.path.is_converged;
    motion = close(*next, found);
  }
  if (motion.constraint_error.is_null())
    return found.path;
  const RCP<Vector> impulse = found.joint_impulse;
  if (!motion.at_end.is_null())
    drop_with_followers(solids.reduction(), *motion.at_end, *impulse);
  found.path.joints.held = solids.reduction().on_given(*impulse);
  solids.reduction().drop_given(*impulse);
  if (!motion.later_impulse.is_null())
    impulse->update(1, *motion.later_impulse, 1);
  found.path.joints.given = impulse;
  return found.path;
}

template <int dim>
SolidPath<dim> PositionUpdate<dim>::find(const StepContext<dim>& context,
                                         const RCP<const Vector>& drag) {
  if (components_.solids->has_unknowns() && components_.solids->joints())
    return find_with_joints(context, drag);
  return find_once(context, drag, {}, nullptr).path;
}

template <int dim>
SolidPath<dim> PositionUpdate<dim>::drift(const StepContext<dim>& context) {
  const auto& solids = *components_.solids;
  const double dt = context.step.dt;
  const auto velocity = rcp(new Vector(*solids.velocity(), Teuchos::Copy));
  velocity->update(1, *solids.velocity_of(*solid_forces_.midpoint_correction(dt / 2)), 1);
  SolidPath<dim> path;
  if (components_.contact)
    path.contact = components_.contact->resolve(solids, ContactPhase::position, dt, *velocity, {});
  path.velocity = velocity;
  return path;
}

template <int dim>
ClosedDrift<dim> PositionUpdate<dim>::closed_drift(const StepContext<dim>& context,
                                                   const Vector& velocity,
                                                   const Vector& correction) {
  auto& solids = *components_.solids;
  const StepTime& step = context.step;
  const auto moved = rcp(new Vector(velocity, Teuchos::Copy));
  ClosedDrift<dim> drift;
  if (components_.contact)
    drift.path.contact = components_.contact->resolve(
        solids, ContactPhase::position, step.dt, *moved, joint_response<dim>(solids, context.dt));
  drift.motion = solids.joints()->close(step.begin, step.dt, correction, velocity, *moved);
  drift.path.velocity = moved;
  return drift;
}

template class PositionUpdate<2>;
template class PositionUpdate<3>;

}  // namespace lockstep
