#include "stepping/solve_audit.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>
#include <cmath>

namespace lockstep {

double largest_divergence(const BlockSystem& blocks, const CoupledSolution& solution,
                          double spacing, int dim) {
  Vector residual(*solution.rhs.pressure, Teuchos::Copy);
  apply(*blocks.pressure_block, *solution.unknowns.pressure, residual, -1, 1);
  if (blocks.has_solid())
    blocks.coupling_transposed->apply(*solution.unknowns.solid, residual, Teuchos::TRANS, 1, 1);
  return residual.normInf() / std::pow(spacing, dim);
}

template <int dim>
void audit_solve(const Components<dim>& components, CoupledSystem<dim>& system,
                 const CoupledSolution& solution, const ViscousResult<dim>& viscous, double dt,
                 StepReport<dim>& report) {
  const SolidSystem<dim>& solids = *components.solids;
  const BlockVector& unknowns = solution.unknowns;
  const Momentum<dim> walls = components.fluid->boundary_pressure_impulse(*unknowns.pressure);
  report.ledger.add("walls", walls);
  report.boundary_impulse = walls + report.ledger.impulse_of("viscous boundaries");
  RCP<Vector> velocity = unknowns.solid;
  if (velocity.is_null())
    velocity = make_vector(solids.map());
  const std::vector<double> coupled_after = components.coupling->velocity(*velocity);
  const std::vector<Momentum<dim>> prescribed = components.coupling->prescribed_impulses(
      solution.coupled_before, coupled_after, *unknowns.pressure);
  report.ledger.add("prescribed solids", total_of(prescribed));
  for (std::size_t s = 0; s < prescribed.size(); ++s)
    report.hydrodynamic_impulse[s] -= prescribed[s];
  for (std::size_t s = 0; s < viscous.prescribed_impulses.size(); ++s)
    report.hydrodynamic_impulse[s] -= viscous.prescribed_impulses[s];
  if (!solids.has_unknowns())
    return;
  const RCP<const Vector> reaction = system.lock_reaction(dt, *solution.momentum, unknowns);
  report.ledger.add("locks", solids.momentum(*reaction));
  report.lever_impulse =
      components.coupling->lever_impulse(solids, solution.coupled_before, coupled_after, unknowns);
  report.ledger.add("levers of soft solids", {Point<dim>::Zero(), report.lever_impulse});
  const RCP<const Vector> implicit = solids.implicit_impulse(dt, *unknowns.solid);
  report.linearisation_impulse =
      solids.momentum(*implicit).angular + solids.inner_angular_impulse(dt);
  report.ledger.add("linearised forces", {Point<dim>::Zero(), report.linearisation_impulse});
  const RCP<Vector> gained = make_vector(solids.map());
  apply(*solids.mass(), *unknowns.solid, *gained);
  gained->update(-1, *solution.momentum, -1, *reaction, 1);
  gained->update(-1, *implicit, 1);
  if (!viscous.solid_impulse.is_null())
    gained->update(1, *viscous.solid_impulse, 1);
  add_each(solids.momentum_of_each(*gained), report.hydrodynamic_impulse);
}

template void audit_solve(const Components<2>&, CoupledSystem<2>&, const CoupledSolution&,
                          const ViscousResult<2>&, double, StepReport<2>&);
template void audit_solve(const Components<3>&, CoupledSystem<3>&, const CoupledSolution&,
                          const ViscousResult<3>&, double, StepReport<3>&);

}  // namespace lockstep
