// A step in two kicks with a drift between them, from t^n to t^{n+1} = t^n + dt: Störmer and
// Verlet's scheme for the coupled system. The geometry is that of x^n in 1, of x^{n+1} in 4.
//
//   1  kick   u* = u^n + dt/2 (a + g + nu lap u*), a what advection changed in the last step, then
//             A p - B V = -G^T u*,  B^T p + C V = M_S V^n + dt/2 f + W^T M_F u*_F;
//             u^{n+1/2} = u* - M^-1 G p, V^{n+1/2} = V; contacts act on V: gap + dt J_n V >= 0
//   2  drift  x^{n+1} = x^n + dt V^{n+1/2}; bodies turn as their angular momenta have it. Joints
//             are closed at x^{n+1} by impulses of 1 (RATTLE), which then is solved anew
//   3         u_ADV = u^{n+1/2}, free of divergence with (x^{n+1} - x^n) / dt; u^{n+1/2} - dt/2 a,
//             scalars and the free surface are carried along it
//   4  kick   as 1 without a, at x^{n+1}: u^{n+1}, V^{n+1}
#include "stepping/step/kick_drift_kick.hpp"

#include <fmt/format.h>

#include <Tpetra_Vector.hpp>
#include <algorithm>

namespace lockstep {

namespace {

/// Adds the impulses of the first kick to the ledger of the second, as if the drift came before
/// both.
template <int dim>
MomentumLedger<dim> joined_books(const MomentumLedger<dim>& first,
                                 const MomentumLedger<dim>& second) {
  MomentumLedger<dim> sum;
  sum.open(second.before() - (first.after() - first.before()));
  for (const auto* ledger : {&first, &second}) {
    for (const auto& [source, impulse] : ledger->entries())
      sum.add(source, impulse);
  }
  sum.close(second.after());
  return sum;
}

template <int dim>
void add_impulses(const std::vector<Momentum<dim>>& more, std::vector<Momentum<dim>>& impulses) {
  if (impulses.empty())
    impulses = more;
  else if (!more.empty())
    add_each(more, impulses);
}

/// The report of a step of two kicks: what each gave is added up, the state is that of the second.
template <int dim>
StepReport<dim> joined(const StepReport<dim>& first, StepReport<dim> report) {
  report.cfl = first.cfl;
  report.s1 = first.s2;
  report.incompatibility_s1 = first.incompatibility_s2;
  report.viscous_iterations += first.viscous_iterations;
  report.viscous_dissipation = (first.viscous_dissipation + report.viscous_dissipation) / 2;
  report.viscous_number += first.viscous_number;
  report.ledger = joined_books(first.ledger, report.ledger);
  report.momentum_error = std::max(first.momentum_error, report.momentum_error);
  report.angular_momentum_error =
      std::max(first.angular_momentum_error, report.angular_momentum_error);
  report.boundary_impulse += first.boundary_impulse;
  report.transport_change += first.transport_change;
  report.lumping_torque_error += first.lumping_torque_error;
  report.linearisation_impulse += first.linearisation_impulse;
  add_impulses(first.hydrodynamic_impulse, report.hydrodynamic_impulse);
  add_impulses(first.contact_impulse, report.contact_impulse);
  if (report.surface_forces)
    *report.surface_forces += *first.surface_forces;
  const ContactReport<dim> drift = report.contact_position;
  report.contact_position = first.contact_velocity;
  report.contact_position.n_contacts =
      std::max(first.contact_velocity.n_contacts, report.contact_velocity.n_contacts);
  report.contact_position.n_crossings = drift.n_crossings;
  report.contact_position.deepest_overlap =
      std::max(drift.deepest_overlap, first.contact_velocity.deepest_overlap);
  if (report.energy)
    *report.energy += *first.energy;
  return report;
}

/// u* and V by the forces over `context`.
template <int dim>
StageResults<dim> kick(StepParts<dim>& parts, const StepContext<dim>& context) {
  StageResults<dim> stages;
  parts.audit.end_transport(context.step);
  stages.forces = parts.prediction.add_forces(context);
  parts.audit.end_forces();
  stages.friction = parts.prediction.add_viscosity(context, stages.forces);
  parts.audit.end_viscosity();
  const ScopedStage timed(parts.timers, context.solve);
  stages.solids = parts.solid_forces.momentum(context);
  stages.end =
      parts.solve.velocities(context, stages.solids, stages.friction.viscous.solid_impulse);
  return stages;
}

/// The first kick of a step, its context and the path that follows from it.
template <int dim>
struct FirstKick {
  StepContext<dim> context;
  StageResults<dim> stages;
  SolidPath<dim> path;          ///< empty without joints
  RCP<const Vector> left_over;  ///< impulse that joints have for the second kick; null: none
};

/// A correction without what belongs to bodies whose joints could not be closed; null: none is
/// left. Their momenta would keep some of it through the turns that kept them open.
RCP<const Vector> of_closed(const ClosedMotion& motion) {
  if (motion.correction.is_null() || motion.at_end.is_null())
    return motion.correction;
  const auto kept = rcp(new Vector(*motion.correction, Teuchos::Copy));
  kept->elementWiseMultiply(-1, *motion.at_end, *motion.correction, 1);
  return kept;
}

/// The first kick of solids with joints: it gives them, and the fluid, the velocities with which
/// the joints are closed at the end of the step. These are means over the way on which the bodies
/// turn; the impulse that makes them such is taken away again by the second kick.
template <int dim>
FirstKick<dim> kick_with_joints(StepParts<dim>& parts, StepContext<dim> context) {
  const auto& solids = *parts.components.solids;
  const RCP<const Vector> correction = parts.solid_forces.midpoint_correction(context.dt);
  context.joints.given = correction;
  StageResults<dim> stages = kick(parts, context);
  const auto drift = [&] {
    RCP<const Vector> given = context.joints.given;
    if (given.is_null())
      given = make_vector(solids.map());
    return parts.positions.closed_drift(context, *stages.end.solution.velocity, *given);
  };
  ClosedDrift<dim> closed = drift();
  const RCP<const Vector> error = closed.motion.constraint_error;
  if (!error.is_null() || correction->normInf() > 0) {
    const ScopedStage timed(parts.timers, context.solve);
    const MotionWithContacts<dim> first = stages.end;
    context.joints.given = of_closed(closed.motion);
    if (!error.is_null())
      context.constraints = solids.constraints(context.step.begin, context.step.end(), error);
    stages.solids = parts.solid_forces.momentum(context);
    stages.end = parts.solve.velocities(
        context, stages.solids, stages.friction.viscous.solid_impulse, &first.solution.unknowns);
    stages.end.solution.report.add_work(first.solution.report);
    if (!error.is_null())
      closed = drift();
  }
  const auto left_over = make_vector(solids.map());
  if (!context.joints.given.is_null())
    left_over->update(-1, *context.joints.given, 0);
  if (!closed.motion.later_impulse.is_null())
    left_over->update(1, *closed.motion.later_impulse, 1);
  return {context, stages, closed.path, left_over};
}

}  // namespace

template <int dim>
std::string hindrance_to_kick_drift_kick(const Components<dim>& components) {
  for (const SolidDescription& solid : components.solids->solids()) {
    if (!solid.rigid && !solid.prescribed)
      return fmt::format("\"{}\" deforms, but the second order in time is one of rigid bodies",
                         solid.name);
  }
  return components.fluid->gas() ? "The second order in time knows no trapped gas" : "";
}

template <int dim>
StepReport<dim> kick_drift_kick(StepParts<dim>& parts, const StepTime& step,
                                const StageRunner& run) {
  auto& solids = *parts.components.solids;
  const double dt = step.dt;
  parts.begin(step);

  // Each pressure acts over half a step. Held dofs have their mean velocities, so that positions
  // follow their scripts.
  const StepTime begin{step.begin, dt, step.last_dt / 2, step.number};
  StepContext<dim> half{begin,  "S1",  step.begin,
                        dt / 2, false, solids.constraints(step.begin, step.end())};
  half.takes_drops = false;
  double divergence = 0;  // before the first kick took it away
  SolidPath<dim> path;
  StartImpulse joints;
  const StepReport<dim> first = run("kick", [&] {
    parts.transport.begin_kick(step);
    const FirstKick<dim> found = solids.joints() ? kick_with_joints(parts, half)
                                                 : FirstKick<dim>{half, kick(parts, half), {}, {}};
    path = found.path;
    joints.given = found.left_over;
    divergence = found.stages.end.solution.rhs.pressure->norm2();
    return parts.finish(found.context, found.stages);
  });
  const StepTime rest{step.begin, dt, dt / 2, step.number};
  parts.audit.begin(rest);
  run("solid motion", [&] {
    if (path.velocity.is_null())
      path = parts.positions.drift(half);
    solids.move(*path.velocity, step.begin, dt);
  });
  // A divergence that the tolerance of the first kick has left is no work for F2.
  const AdvectionReport advection = run("F2", [&] {
    return parts.advection.make_from_kick(rest, parts.advection.tolerance() * divergence);
  });
  run("F3 advection", [&] { parts.transport.carry(rest); });
  const StepContext<dim> whole{rest,   "S2",  step.begin + dt / 2,
                               dt / 2, false, solids.constraints(step.end(), step.end()),
                               joints};
  return run("kick", [&] {
    StageResults<dim> stages = kick(parts, whole);
    stages.advection = advection;
    stages.path = path;
    return joined(first, parts.finish(whole, stages));
  });
}

template std::string hindrance_to_kick_drift_kick(const Components<2>&);
template std::string hindrance_to_kick_drift_kick(const Components<3>&);
template StepReport<2> kick_drift_kick(StepParts<2>&, const StepTime&, const StageRunner&);
template StepReport<3> kick_drift_kick(StepParts<3>&, const StepTime&, const StageRunner&);

}  // namespace lockstep
