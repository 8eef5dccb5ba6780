#include "stepping/step/coupled_solve.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>

#include "base/errors.hpp"
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
void CoupledSolve<dim>::check_start(double time) const {
  // Motions that begin at rest do so but for round-off.
  const double negligible = 1e-12 * components_.fluid->fluid_volume();  // a second
  const std::string impossible =
      system_.impossible_flow(time, components_.solids->constraints(time, time), negligible);
  check_input(impossible.empty(), "At the start: {}", impossible);
}

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
/// as the user wants, about that velocity; then, where the energy of the step would otherwise rise,
/// about the motion that lowers it most under the pressure found. False: the solution stands.
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
    solids.linearise(context.dt, velocity);
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

template <int dim>
MotionWithContacts<dim> CoupledSolve<dim>::velocities(const StepContext<dim>& context,
                                                      const SolidMomentum<dim>& solids,
                                                      const RCP<const Vector>& drag,
                                                      const BlockVector* nearby) {
  constexpr double round_off = 1e-9;
  const auto momentum = rcp(new Vector(*solids.momentum, Teuchos::Copy));
  if (!drag.is_null())
    momentum->update(1, *drag, 1);
  MotionWithContacts<dim> end;
  if (components_.contact && components_.solids->has_unknowns()) {
    end = converge_with_contacts(context, momentum, nearby);
    if (end.contact.n_contacts > 0)
      end.contact_impulse = end.contact.impulse;
  } else {
    end.solution = converge(context, momentum, nearby);
  }
  if (end.solution.incompatibility > round_off) {
    const double time = context.step.end();
    const std::string impossible = system_.impossible_flow(time, context.constraints);
    check_solve(impossible.empty(), "At {:.6g} s: {}", time, impossible);
  }
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
