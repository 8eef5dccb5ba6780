#include <Tpetra_Vector.hpp>

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
  components_.coupling->set_prescribed_motion(*components_.solids, Coupling<dim>::Motion::present);
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
  auto& solids = *components_.solids;
  {
    ScopedPhase phase(timers_, "forces");
    Momentum<dim> impulse = fluid.add_forces(time, dt);
    if (ledger) {
      const auto increment = fluid.coupled_force(time, dt);
      impulse += system_.lumped_fluid_momentum(increment);
      ledger->add("body forces", impulse);
    }
  }
  viscous_ = {};
  if (!fluid.is_viscous())
    return;
  ScopedPhase phase(timers_, "viscosity");
  const std::unique_ptr<ViscousSystem<dim>> viscous = fluid.viscous_system();
  RCP<const LinearOperator> block;
  NearNullSpace near_null_space;
  RCP<Vector> row;
  if (coupled()) {
    const BlockSystem& blocks = system_.blocks(dt);
    block = blocks.solid_block;
    near_null_space = blocks.near_null_space;
    const RCP<Vector> momentum = solids.explicit_momentum(time, dt);
    row = system_.lumped_momentum(*momentum);
    if (!locked_velocity_.is_null())
      row->update(-1, *system_.unlocked_momentum(dt, *locked_velocity_), 1);
  }
  viscous_ =
      solve_viscous<dim>(*viscous, fluid, solids, *components_.coupling, block, near_null_space,
                         row, dt, options_.viscous_tolerance, locked_velocity_);
  report.viscous_iterations += viscous_.iterations;
  if (ledger)
    ledger->add("viscous boundaries", viscous_.boundary_impulse);
}

template void Stepper<2>::reset_unseen_faces();
template void Stepper<3>::reset_unseen_faces();
template void Stepper<2>::predict_forces(double, double, MomentumLedger<2>*, StepReport<2>&);
template void Stepper<3>::predict_forces(double, double, MomentumLedger<3>*, StepReport<3>&);

}  // namespace lockstep
