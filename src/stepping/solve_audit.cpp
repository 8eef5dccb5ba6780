#include "stepping/solve_audit.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>
#include <cmath>
#include <limits>

namespace lockstep {

double largest_divergence(const BlockSystem& blocks, const CoupledSolution& solution,
                          double spacing, int dim) {
  Vector residual(*solution.rhs.pressure, Teuchos::Copy);
  apply(*blocks.pressure_block(), *solution.unknowns.pressure, residual, -1, 1);
  if (blocks.has_solid())
    blocks.coupling_transposed()->apply(*solution.unknowns.solid, residual, Teuchos::TRANS, 1, 1);
  return residual.normInf() / std::pow(spacing, dim);
}

template <int dim>
void audit_solve(const Components<dim>& components, const ComponentSides<dim>& sides,
                 CoupledSystem<dim>& system, const StepContext<dim>& context,
                 const CoupledSolution& solution, const ViscousResult<dim>& viscous,
                 StepReport<dim>& report) {
  const SolidSystem<dim>& solids = *components.solids;
  const BlockVector whole{solution.unknowns.pressure, solution.velocity};
  const Momentum<dim> walls = sides.audited_fluid
                                  ? sides.audited_fluid->boundary_pressure_impulse(*whole.pressure)
                                  : Momentum<dim>();
  report.ledger.add("walls", walls);
  if (!solution.gas_momentum.is_null())  // gas pushes on what is around it; sides push back
    report.ledger.add("walls through gas",
                      sides.gas_fluid->gas_side_impulse(solution.gas_pressure));
  report.boundary_impulse = walls + report.ledger.impulse_of("viscous boundaries");
  const std::vector<double> coupled_after = components.coupling->velocity(*whole.solid);
  std::vector<Momentum<dim>> prescribed;
  if (sides.audited_coupling)
    prescribed = sides.audited_coupling->prescribed_impulses(
        solution.coupled_before, coupled_after, *whole.pressure, solution.gas_pressure);
  report.ledger.add("prescribed solids", total_of(prescribed));
  for (std::size_t s = 0; s < prescribed.size(); ++s)
    report.hydrodynamic_impulse[s] -= prescribed[s];
  for (std::size_t s = 0; s < viscous.prescribed_impulses.size(); ++s)
    report.hydrodynamic_impulse[s] -= viscous.prescribed_impulses[s];
  if (!solids.has_unknowns())
    return;
  Vector given(*solution.momentum, Teuchos::Copy);
  if (!solution.gas_momentum.is_null())
    given.update(1, *solution.gas_momentum, 1);
  const RCP<const Vector> reactions =
      system.reactions(context.dt, context.constraints, given, whole);
  report.ledger.add("locks", solids.momentum(*reactions));
  report.reactions = reactions;
  if (sides.audited_coupling)
    report.lever_impulse = sides.audited_coupling->lever_impulse(
        solids, solution.coupled_before, coupled_after, whole, solution.gas_pressure);
  report.ledger.add("levers of soft solids", {Point<dim>::Zero(), report.lever_impulse});
  const RCP<const Vector> implicit = solids.implicit_impulse(context.dt, *whole.solid);
  report.linearisation_impulse =
      solids.momentum(*implicit).angular + solids.inner_angular_impulse(context.dt);
  report.ledger.add("linearised forces", {Point<dim>::Zero(), report.linearisation_impulse});
  const RCP<Vector> gained = make_vector(solids.map());
  apply(*solids.mass(), *whole.solid, *gained);
  gained->update(-1, *solution.momentum, -1, *reactions, 1);
  gained->update(-1, *implicit, 1);
  if (!viscous.solid_impulse.is_null())
    gained->update(1, *viscous.solid_impulse, 1);
  add_each(solids.momentum_of_each(*gained), report.hydrodynamic_impulse);
}

template <int dim>
void audit_momentum(const Components<dim>& components, const ComponentSides<dim>& sides,
                    StepReport<dim>& report) {
  if (!sides.audited) {
    report.momentum_error = report.angular_momentum_error =
        std::numeric_limits<double>::quiet_NaN();
    return;
  }
  // sum m |u| >= sum m u^2 / max |u|
  const double fastest = components.fluid->largest_speed();
  const double momentum_scale = fastest > 0 ? 2 * report.fluid_kinetic_energy / fastest : 0;
  report.momentum_error = report.ledger.linear_error(momentum_scale);
  const double extent = components.fluid->bounds().sizes().maxCoeff();
  const double length = std::isfinite(extent) ? extent : std::pow(report.fluid_volume, 1.0 / dim);
  if (!components.fluid->is_periodic())
    report.angular_momentum_error = report.ledger.angular_error(length, momentum_scale);
}

template void audit_momentum(const Components<2>&, const ComponentSides<2>&, StepReport<2>&);
template void audit_momentum(const Components<3>&, const ComponentSides<3>&, StepReport<3>&);
template void audit_solve(const Components<2>&, const ComponentSides<2>&, CoupledSystem<2>&,
                          const StepContext<2>&, const CoupledSolution&, const ViscousResult<2>&,
                          StepReport<2>&);
template void audit_solve(const Components<3>&, const ComponentSides<3>&, CoupledSystem<3>&,
                          const StepContext<3>&, const CoupledSolution&, const ViscousResult<3>&,
                          StepReport<3>&);

}  // namespace lockstep
