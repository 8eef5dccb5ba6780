// The parts of the step that solids with implicit inner forces add.
#include <Tpetra_Vector.hpp>

#include "coupling/unlinear_bodies.hpp"
#include "stepping/implicit_motion.hpp"
#include "stepping/stepper.hpp"

namespace lockstep {

namespace {
/// Of the motion of each solid whose inner forces are implicit, the part that the step resolves:
/// one where it is short for them, V.K V dt^2 small beside V.M V, nothing where it is long. In its
/// own frame: a translation is no motion that forces would have to resolve.
template <int dim>
std::vector<double> resolved_parts(const SolidSystem<dim>& solids,
                                   const UnlinearBodies<dim>& bodies,
                                   const RCP<const CrsMatrix>& added_mass, double dt) {
  const RCP<const Vector> velocity = bodies.without_translations(*solids.velocity());
  const std::vector<double> given = bodies.dot(*velocity, *solids.implicit_impulse(dt, *velocity));
  Vector product(solids.map());
  apply(*solids.full_block(added_mass, dt), *velocity, product);
  const std::vector<double> whole = bodies.dot(*velocity, product);
  std::vector<double> parts;
  for (std::size_t s = 0; s < whole.size(); ++s) {
    const double stiff = -given[s];
    if (!(stiff > 0) || !(whole[s] > stiff)) {
      parts.push_back(stiff > 0 ? 0 : 1);
      continue;
    }
    const double ratio = 2 * stiff / (whole[s] - stiff);
    parts.push_back(1 / ((1 + ratio) * (1 + ratio)));
  }
  return parts;
}
}  // namespace

/// That of the solids themselves.
template <int dim>
RCP<Vector> Stepper<dim>::midpoint_correction(double dt) const {
  const auto& solids = *components_.solids;
  const RCP<Vector> correction = make_vector(solids.map());
  solids.add_midpoint_correction(dt, *correction);
  if (solids.has_implicit_forces()) {
    const UnlinearBodies<dim> bodies(solids);
    bodies.scale(resolved_parts(solids, bodies, components_.coupling->added_mass(), dt),
                 *correction);
  }
  return correction;
}

/// Newton's method on the elastic forces at the positions that the solution reaches: every
/// iteration is a coupled solve, whose explicit momentum differs from the last one's by theirs.
template <int dim>
CoupledSolution Stepper<dim>::solve_newton(const StepContext<dim>& context,
                                           const RCP<Vector>& momentum, SolveReport& report,
                                           double& incompatibility, const BlockVector* nearby) {
  auto& solids = *components_.solids;
  const std::string name = name_of(context.stage);
  CoupledSolution solution = solve(context, momentum, name, report, incompatibility, nearby);
  for (int k = 1; k < options_.newton_iterations && coupled(); ++k) {
    const RCP<const Vector> before = solids.explicit_momentum(context.time, context.dt);
    if (!solids.linearise(context.dt, *solution.velocity))
      break;
    momentum->update(1, *solids.explicit_momentum(context.time, context.dt), -1, *before, 1);
    const SolveReport earlier = report;
    solution = solve(context, momentum, name, report, incompatibility, &solution.unknowns);
    report.add_work(earlier);
  }
  return solution;
}

/// Where inner forces are implicit contact acts on V_S* = (M_S - dt D)^-1 momentum, so that it
/// holds what it would have to at the end of the step, and finds the forces of that place.
template <int dim>
ContactReport<dim> Stepper<dim>::settled_momentum(const StepContext<dim>& context,
                                                  Vector& momentum) {
  auto& solids = *components_.solids;
  const auto response = implicit_response<dim>(solids, context.dt);
  const RCP<const Vector> predicted =
      solids.velocity_of(momentum, context.dt, context.constraints, *response);
  const SettledMotion<dim> settled = settle_motion<dim>(
      solids, components_.contact.get(), context, {}, *predicted, *predicted, momentum, response);
  if (!settled.contact.impulse.is_null())
    momentum.update(1, *settled.contact.impulse, 1);
  return settled.contact;
}

/// S2. Where the forces at the end of the step are not those that were linearised, the solids find
/// their motion under the pressure found, and the solve is repeated about that.
template <int dim>
CoupledSolution Stepper<dim>::solve_settled(const StepContext<dim>& context,
                                            const RCP<Vector>& momentum, StepReport<dim>& report) {
  constexpr int most_repeats = 3;
  auto& solids = *components_.solids;
  CoupledSolution solution = solve_newton(context, momentum, report.s2, report.incompatibility_s2);
  if (!coupled() || !solids.has_implicit_forces())
    return solution;
  int k = 0;
  for (; k < most_repeats && !is_settled(solids, context.dt, *solution.velocity); ++k) {
    settle_motion<dim>(solids, nullptr, context, {}, *solution.velocity, *solution.velocity,
                       *momentum);
    const SolveReport earlier = report.s2;
    solution = solve(context, momentum, name_of(context.stage), report.s2,
                     report.incompatibility_s2, &solution.unknowns);
    report.s2.add_work(earlier);
  }
  if (k == most_repeats)
    report.is_settled = report.is_settled && is_settled(solids, context.dt, *solution.velocity);
  return solution;
}

template CoupledSolution Stepper<2>::solve_newton(const StepContext<2>&, const RCP<Vector>&,
                                                  SolveReport&, double&, const BlockVector*);
template CoupledSolution Stepper<3>::solve_newton(const StepContext<3>&, const RCP<Vector>&,
                                                  SolveReport&, double&, const BlockVector*);
template RCP<Vector> Stepper<2>::midpoint_correction(double) const;
template ContactReport<2> Stepper<2>::settled_momentum(const StepContext<2>&, Vector&);
template CoupledSolution Stepper<2>::solve_settled(const StepContext<2>&, const RCP<Vector>&,
                                                   StepReport<2>&);
template RCP<Vector> Stepper<3>::midpoint_correction(double) const;
template ContactReport<3> Stepper<3>::settled_momentum(const StepContext<3>&, Vector&);
template CoupledSolution Stepper<3>::solve_settled(const StepContext<3>&, const RCP<Vector>&,
                                                   StepReport<3>&);

}  // namespace lockstep
