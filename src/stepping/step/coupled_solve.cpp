#include "stepping/step/coupled_solve.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>

#include "coupling/solid_totals.hpp"
#include "linear/null_space.hpp"

namespace lockstep {

template <int dim>
CoupledSolve<dim>::CoupledSolve(Components<dim>& components, CoupledSystem<dim>& system,
                                const CoupledSolveOptions& options, StageTimers& timers)
    : components_(components),
      system_(system),
      options_(options),
      gas_(components),
      timers_(timers) {}

template <int dim>
CoupledSolution CoupledSolve<dim>::solve(const StepContext<dim>& context,
                                         const RCP<Vector>& momentum, const std::string& name,
                                         const BlockVector* nearby) {
  const Reduction& constraints = context.constraints;
  const auto& fluid = *components_.fluid;
  const auto& solids = *components_.solids;
  CoupledSolution solution;
  solution.momentum = momentum;
  solution.coupled_before = fluid.coupled_velocity();
  {
    ScopedStage stage(timers_, "right-hand side");
    solution.rhs =
        system_.right_hand_side(*momentum, context.dt, constraints, solution.incompatibility);
  }
  const BlockSystem& blocks = system_.blocks(context.dt);
  solution.unknowns.pressure = nearby ? rcp(new Vector(*nearby->pressure, Teuchos::Copy))
                                      : last_pressure(fluid, context.step, context.dt);
  project_out(blocks.null_space, *solution.unknowns.pressure);
  if (solids.has_unknowns()) {
    solution.unknowns.solid =
        nearby ? rcp(new Vector(*nearby->solid, Teuchos::Copy)) : solids.velocity();
    constraints.select(*solution.unknowns.solid);
  }
  {
    ScopedStage stage(timers_, "preconditioner");
    components_.strategy->prepare(blocks);
  }
  ScopedStage stage(timers_, "iterations");
  gas_.solve(context, blocks,
             solve_request(fluid, name, options_.tolerance, context.step, context.dt), solution);
  solution.velocity = solids.has_unknowns() ? solution.unknowns.solid : make_vector(solids.map());
  if (!constraints.is_identity()) {
    solution.velocity = rcp(new Vector(*solution.velocity, Teuchos::Copy));
    constraints.expand(*solution.velocity);
  }
  return solution;
}

template <int dim>
CoupledSolution CoupledSolve<dim>::converge(const StepContext<dim>& context,
                                            const RCP<Vector>& momentum,
                                            const BlockVector* nearby) {
  CoupledSolution solution = solve(context, momentum, context.solve, nearby);
  for (int n_solves = 1; improve(context, n_solves, solution, *momentum); ++n_solves) {
    CoupledSolution next = solve(context, momentum, context.solve, &solution.unknowns);
    next.report.add_work(solution.report);
    solution = next;
  }
  return solution;
}

/// Linearises implicit forces anew if they are not yet those at the velocity found: first, as often
/// as the user wants, about that velocity or part of the way to it; then, where the energy of the
/// step would otherwise rise, about the motion that lowers it most under the pressure found. False:
/// the solution stands.
template <int dim>
bool CoupledSolve<dim>::improve(const StepContext<dim>& context, int n_solves,
                                CoupledSolution& solution, Vector& momentum) {
  constexpr int most_searches = 3;
  auto& solids = *components_.solids;
  if (!solids.has_unknowns() || !has_implicit_forces(solids))
    return false;
  const Vector& velocity = *solution.velocity;
  if (n_solves < options_.newton_iterations) {
    const RCP<const Vector> before = solids.explicit_momentum(context.begin, context.dt);
    solids.linearise(context.dt, *tolerable_velocity<dim>(solids, context.dt, velocity));
    momentum.update(1, *solids.explicit_momentum(context.begin, context.dt), -1, *before, 1);
    return true;
  }
  if (context.moves_positions)
    return false;
  solution.is_converged = is_settled(solids, context.dt, velocity);
  if (solution.is_converged || n_solves == options_.newton_iterations + most_searches)
    return false;
  settle_motion<dim>(solids, nullptr, context, {velocity, velocity}, momentum);
  return true;
}

namespace {
/// Contact acts on V_S* = M_S^-1 momentum; its impulses go into the momentum. With implicit inner
/// forces V_S* = (M_S - dt D)^-1 momentum, so that contact holds what it would have to at the end
/// of the step, and forces are linearised there.
template <int dim>
ContactReport<dim> contact_before_solve(Components<dim>& components,
                                        const StepContext<dim>& context, Vector& momentum) {
  auto& solids = *components.solids;
  auto& contact = *components.contact;
  const double dt = context.dt;
  if (has_implicit_forces(solids)) {
    const auto inverse = implicit_response<dim>(solids, dt);
    const RCP<const Vector> predicted =
        solids.velocity_of(momentum, dt, context.constraints, *inverse);
    const SettledMotion<dim> settled = settle_motion<dim>(
        solids, &contact, context, {*predicted, *predicted, {}, inverse}, momentum);
    if (!settled.contact.impulse.is_null())
      momentum.update(1, *settled.contact.impulse, 1);
    return settled.contact;
  }
  const ContactResponse response = joint_response<dim>(solids, dt);
  const RCP<Vector> velocity =
      response ? solids.velocity_of(momentum, dt, context.constraints, *response())
               : solids.velocity_of(momentum, 0, context.constraints);
  Vector change(*velocity, Teuchos::Copy);
  const ContactReport<dim> report =
      contact.resolve(solids, ContactPhase::velocity, dt, *velocity, response);
  if (!report.impulse.is_null()) {
    momentum.update(1, *report.impulse, 1);
  } else if (report.n_contacts > 0) {
    change.update(1, *velocity, -1);
    apply(*solids.mass(), change, momentum, 1, 1);
  }
  return report;
}
}  // namespace

template <int dim>
MotionWithContacts<dim> CoupledSolve<dim>::velocities(const StepContext<dim>& context,
                                                      const SolidMomentum<dim>& solids,
                                                      const RCP<const Vector>& drag,
                                                      const BlockVector* nearby) {
  constexpr double round_off = 1e-9;
  const auto momentum = rcp(new Vector(*solids.momentum, Teuchos::Copy));
  MotionWithContacts<dim> end;
  if (holds_contacts()) {
    const auto given = rcp(new Vector(*momentum, Teuchos::Copy));
    if (!drag.is_null())
      given->update(1, *drag, 1);
    end = converge_with_contacts(context, given, nearby);
    if (end.contact.n_contacts > 0)
      end.contact_impulse = end.contact.impulse;
  }
  if (!holds_contacts() || !end.is_settled) {
    const MotionWithContacts<dim> attempt = end;
    end = {};
    if (components_.contact && components_.solids->has_unknowns()) {
      const RCP<const Vector> at_rest = impulse_at_rest(components_, context.dt);
      momentum->update(1, *at_rest, 1);
      const auto impulse = rcp(new Vector(*momentum, Teuchos::Copy));
      {
        ScopedStage stage(timers_, "contact");
        end.contact = contact_before_solve(components_, context, *momentum);
      }
      impulse->update(1, *momentum, -1);
      if (end.contact.n_contacts > 0)
        end.contact_impulse = impulse;
      momentum->update(-1, *at_rest, 1);
      end.contact.n_solves = attempt.contact.n_solves;
      end.contact.residual = attempt.contact.residual;
      end.contact.n_outside = end.contact.n_contacts > 0 ? 1 : 0;
    }
    if (!drag.is_null())
      momentum->update(1, *drag, 1);
    end.solution = converge(context, momentum, nearby);
    end.solution.report.add_work(attempt.solution.report);
  }
  const double time = context.step.end();
  const std::string impossible = end.solution.incompatibility > round_off
                                     ? system_.impossible_flow(time, context.constraints)
                                     : system_.squeezing_flow(time);
  check_solve(impossible.empty(), "At {:.6g} s: {}", time, impossible);
  return end;
}

template <int dim>
void CoupledSolve<dim>::project(const CoupledSolution& solution,
                                const RCP<const Vector>& viscous_pressure) {
  auto& fluid = *components_.fluid;
  gas_.project(*solution.unknowns.pressure, solution.gas_pressure);
  if (!viscous_pressure.is_null())
    fluid.correct_pressure(*viscous_pressure);
  fluid.set_coupled_velocity(components_.coupling->velocity(*solution.velocity));
}

template <int dim>
void CoupledSolve<dim>::accept(const StepContext<dim>& context, const MotionWithContacts<dim>& end,
                               const RCP<const Vector>& reactions) {
  auto& solids = *components_.solids;
  components_.fluid->accept();
  if (!solids.has_unknowns())
    return;
  solids.set_velocity(*end.solution.velocity);
  if (!solids.joints())
    return;
  // Contact acts before the solve, which finds what is left.
  Vector given(*reactions, Teuchos::Copy);
  if (!end.contact.reactions.is_null())
    given.update(1, *end.contact.reactions, 1);
  solids.joints()->take_note(
      {context.joints.held, solids.reduction().on_given(given), end.contact.limit_impulses},
      context.begin, context.dt);
}

template class CoupledSolve<2>;
template class CoupledSolve<3>;

}  // namespace lockstep
