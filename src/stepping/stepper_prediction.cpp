#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>

#include <cmath>

#include "stepping/stepper.hpp"

namespace lockstep {

/// A mixed face that no fluid cell sees holds solid velocity, not stale fluid: W V_S^n, before
/// forces.
template <int dim>
void Stepper<dim>::reset_unseen_faces() {
  const auto& volumes = components_.fluid->coupled_volumes();
  GlobalIndex unseen = 0;
  for (const auto& volume : volumes)
    unseen += volume.seen_by_fluid ? 0 : 1;
  if (sum_all(components_.solids->comm(), unseen) == 0)
    return;
  const std::vector<double> solid = components_.coupling->velocity(*components_.solids->velocity());
  std::vector<double> velocity = components_.fluid->coupled_velocity();
  for (std::size_t f = 0; f < volumes.size(); ++f) {
    if (!volumes[f].seen_by_fluid)
      velocity[f] = solid[f];
  }
  components_.fluid->set_coupled_velocity(velocity);
}

/// F1 and the forces of F3: explicit forces and implicit viscosity on u*.
template <int dim>
void Stepper<dim>::predict_forces(double time, double dt, MomentumLedger<dim>* ledger,
                                  StepReport<dim>& report) {
  auto& fluid = *components_.fluid;
  {
    ScopedPhase phase(timers_, "forces");
    const ForceImpulse<dim> given = fluid.add_forces(time, dt);
    if (ledger)
      ledger->add("body forces",
                  given.impulse + system_.lumped_fluid_momentum(given.coupled_change));
  }
  viscous_ = {};
  if (!sides_.viscous_fluid)
    return;
  predict_viscosity(time, dt, report);
  if (ledger)
    ledger->add("viscous boundaries", viscous_.boundary_impulse);
}

/// p̂ that the viscous solve reads: that of the last step, before the first one that of a solve
/// without viscosity.
template <int dim>
RCP<const Vector> Stepper<dim>::expected_pressure(double time, double dt, StepReport<dim>& report) {
  if (last_dt_ > 0)
    return last_pressure(dt);
  const RCP<Vector> momentum = coupled() ? solid_momentum(time, dt, nullptr, report)
                                         : make_vector(components_.solids->map());
  SolveReport iterations;
  double incompatibility = 0;
  return solve(dt, momentum, "first pressure", iterations, incompatibility).unknowns.pressure;
}

/// Implicit viscosity in the incremental form of pressure correction (Guermond, Minev and Shen
/// 2006): fluid and solids feel the expected pressure while they feel viscosity, and give it back
/// before S1 or S2 finds the pressure, whole. Their velocities then are nearly those at the end of
/// the step, so that forces that the pressure holds (weight, mean gradients) do not shear the fluid
/// at walls and solids; a steady state does not depend on dt.
template <int dim>
void Stepper<dim>::predict_viscosity(double time, double dt, StepReport<dim>& report) {
  auto& fluid = *components_.fluid;
  RCP<const Vector> pressure;
  if (options_.incremental_pressure)
    pressure = expected_pressure(time, dt, report);
  ScopedPhase phase(timers_, "viscosity");
  RCP<const LinearOperator> block;
  NearNullSpace near_null_space;
  RCP<Vector> row;
  if (coupled()) {
    const BlockSystem& blocks = system_.blocks(dt);
    block = blocks.solid_block;
    near_null_space = blocks.near_null_space;
    const RCP<Vector> momentum = components_.solids->explicit_momentum(time, dt);
    if (!pressure.is_null() && sides_.unseen_buoyancy)
      sides_.unseen_buoyancy->add_unseen_buoyancy(fluid.gravity(), dt, *momentum);
    row = system_.lumped_momentum(*momentum);
    if (!pressure.is_null())
      blocks.coupling_transposed->apply(*pressure, *row, Teuchos::NO_TRANS, -1, 1);
    if (!locked_velocity_.is_null())
      row->update(-1, *system_.unlocked_momentum(dt, *locked_velocity_), 1);
  }
  if (!pressure.is_null())
    fluid.project(*pressure);
  const std::unique_ptr<ViscousSystem<dim>> viscous = sides_.viscous_fluid->viscous_system();
  viscous_ = solve_viscous<dim>(*viscous, *sides_.viscous_fluid, *components_.solids,
                                *sides_.viscous_coupling, block, near_null_space, row, dt,
                                options_.viscous_tolerance, locked_velocity_);
  report.viscous_iterations += viscous_.iterations;
  const double full_mass = viscous->mass->normInf();
  if (full_mass > 0)
    report.viscous_number =
        viscous->viscosity * dt * std::pow(fluid.smallest_length(), dim - 2) / full_mass;
  if (options_.rotational_pressure)
    viscous_pressure_ = viscous_pressure(viscous->viscosity, dt);
  if (!pressure.is_null()) {
    Vector back(*pressure, Teuchos::Copy);
    back.scale(-1);
    fluid.project(back);
  }
}

/// What the projection of a velocity that feels pressure and viscosity leaves out of the pressure,
/// -mu div u' (Timmermans, Minev and van de Vosse 1996). The projection alone finds a pressure that
/// answers to inertia; where nu dt > h^2 viscosity answers first, and without this part the
/// pressure would need nu dt / h^2 steps to follow. Where a cell is cut it is less than it might
/// be.
template <int dim>
RCP<Vector> Stepper<dim>::viscous_pressure(double viscosity, double dt) {
  auto& fluid = *components_.fluid;
  auto& coupling = *components_.coupling;
  const auto result = make_vector(fluid.pressure_map());
  fluid.divergence(*result);
  coupling.add_prescribed_divergence(*result);
  if (coupled())
    coupling.coupling_transposed()->apply(*viscous_.solid_velocity, *result, Teuchos::TRANS, 1, 1);
  result->scale(dt * viscosity);
  return result;
}

template void Stepper<2>::reset_unseen_faces();
template void Stepper<3>::reset_unseen_faces();
template void Stepper<2>::predict_forces(double, double, MomentumLedger<2>*, StepReport<2>&);
template void Stepper<3>::predict_forces(double, double, MomentumLedger<3>*, StepReport<3>&);

}  // namespace lockstep
