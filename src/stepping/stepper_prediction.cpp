// What is done to the fluid before S1 and S2: F1, F2 and F3.
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>
#include <cmath>

#include "linear/null_space.hpp"
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
Prediction<dim> Stepper<dim>::predict_forces(const StepContext<dim>& context,
                                             StepReport<dim>& report) {
  auto& fluid = *components_.fluid;
  const auto* liquid = liquid_of<dim>(fluid);
  Momentum<dim> tension;
  {
    ScopedStage stage(timers_, "forces");
    const ForceImpulse<dim> given = fluid.add_forces(context.time, context.dt);
    if (context.ledger) {
      tension = liquid ? liquid->surface_impulse() : Momentum<dim>();
      context.ledger->add(
          "body forces",
          given.impulse + system_.lumped_fluid_momentum(given.coupled_change) - tension);
      if (liquid)
        context.ledger->add("surface tension", tension);
    }
  }
  if (energy_ && context.stage == Stage::F3)
    energy_->end_forces();
  if (!sides_.viscous_fluid)
    return {};
  Prediction<dim> prediction = predict_viscosity(context, report);
  if (context.ledger) {
    const Momentum<dim> implicit = liquid ? liquid->surface_impulse() - tension : Momentum<dim>();
    context.ledger->add("viscous boundaries", prediction.viscous.boundary_impulse - implicit);
    if (liquid)
      context.ledger->add("surface tension", implicit);
  }
  return prediction;
}

/// What the viscous solve reads: p̂ and that of pockets of gas, those of the last step. In the first
/// two steps that of a solve without viscosity: what the first step's pressure did to velocities
/// that were no flow at the start is an impulse, and comes once. A fluid may ask for the latter in
/// every step.
template <int dim>
ExpectedPressure Stepper<dim>::expected_pressure(const StepContext<dim>& context,
                                                 StepReport<dim>& report) {
  if (n_steps_ > 1 && !sides_.viscous_fluid->wants_present_pressure())
    return {last_pressure(context.dt),
            has_gas() ? expected_gas_pressure(context.dt) : std::vector<double>(),
            {}};
  const RCP<Vector> momentum = coupled() ? solid_momentum(context.on_trial(), {}, report)
                                         : make_vector(components_.solids->map());
  ExpectedPressure result;
  double incompatibility = 0;
  const CoupledSolution solution =
      solve(context, momentum, "first pressure", result.work, incompatibility);
  result.of_fluid = solution.unknowns.pressure;
  result.of_gas = solution.gas_pressure;
  return result;
}

/// Implicit viscosity in the incremental form of pressure correction (Guermond, Minev and Shen
/// 2006): fluid and solids feel the expected pressure while they feel viscosity, and give it back
/// before S1 or S2 finds the pressure, whole. Their velocities then are nearly those at the end of
/// the step, so that forces that the pressure holds (weight, mean gradients) do not shear the fluid
/// at walls and solids; a steady state does not depend on dt.
template <int dim>
Prediction<dim> Stepper<dim>::predict_viscosity(const StepContext<dim>& context,
                                                StepReport<dim>& report) {
  const double dt = context.dt;
  auto& fluid = *components_.fluid;
  ExpectedPressure expected;
  if (options_.incremental_pressure || sides_.viscous_fluid->wants_present_pressure())
    expected = expected_pressure(context, report);
  const RCP<const Vector>& pressure = expected.of_fluid;
  ScopedStage stage(timers_, "viscosity");
  RCP<const LinearOperator> block;
  SoftNodes soft_nodes;
  RCP<Vector> row;
  if (coupled()) {
    const BlockSystem& blocks = system_.blocks(dt);
    block = blocks.solid_block();
    soft_nodes = blocks.soft_nodes;
    const RCP<Vector> momentum = explicit_momentum(context);
    if (!pressure.is_null() && sides_.unseen_buoyancy)
      sides_.unseen_buoyancy->add_unseen_buoyancy(fluid.gravity(), dt, *momentum);
    row = system_.lumped_momentum(*momentum);
    if (!pressure.is_null())
      components_.coupling->coupling_transposed()->apply(*pressure, *row, Teuchos::NO_TRANS, -1, 1);
    system_.subtract_given(dt, context.constraints, *row);
  }
  if (!expected.of_gas.empty() && !row.is_null())
    sides_.gas_coupling->add_gas_push(expected.of_gas, *row);
  if (!pressure.is_null())
    project(*pressure, expected.of_gas);
  const std::unique_ptr<ViscousSystem<dim>> viscous = sides_.viscous_fluid->viscous_system();
  Prediction<dim> prediction;
  prediction.pressure_work = expected.work;
  prediction.viscous = solve_viscous<dim>(
      *viscous, *sides_.viscous_fluid, *components_.solids, *sides_.viscous_coupling, block,
      soft_nodes, row, dt, context.constraints, options_.viscous, !context.moves_positions());
  report.viscous_iterations += prediction.viscous.iterations;
  report.viscous_dissipation = prediction.viscous.dissipation;  // of F3, which alone asks for it
  const double full_mass = viscous->mass->normInf();
  if (full_mass > 0)
    report.viscous_number =
        viscous->viscosity * dt * std::pow(fluid.smallest_length(), dim - 2) / full_mass;
  if (options_.rotational_pressure)
    prediction.pressure =
        viscous_pressure(viscous->viscosity, dt, prediction.viscous.solid_velocity);
  if (!pressure.is_null()) {
    Vector back(*pressure, Teuchos::Copy);
    back.scale(-1);
    std::vector<double> gas_back = expected.of_gas;
    for (double& value : gas_back)
      value = -value;
    project(back, gas_back);
  }
  return prediction;
}

/// What the projection of a velocity that feels pressure and viscosity leaves out of the pressure,
/// -mu div u' (Timmermans, Minev and van de Vosse 1996). The projection alone finds a pressure that
/// answers to inertia; where nu dt > h^2 viscosity answers first, and without this part the
/// pressure would need nu dt / h^2 steps to follow. Where a cell is cut it is less than it might
/// be.
template <int dim>
RCP<Vector> Stepper<dim>::viscous_pressure(double viscosity, double dt,
                                           const RCP<const Vector>& velocity) {
  auto& fluid = *components_.fluid;
  auto& coupling = *components_.coupling;
  const auto result = make_vector(fluid.pressure_map());
  fluid.divergence(*result);
  coupling.add_prescribed_divergence(*result);
  if (coupled())
    coupling.coupling_transposed()->apply(*velocity, *result, Teuchos::TRANS, 1, 1);
  result->scale(dt * viscosity);
  return result;
}

/// F2: u_ADV from u^n with the effective solid velocity as Neumann data.
template <int dim>
void Stepper<dim>::make_advection_velocity(double dt, StepReport<dim>& report) {
  auto& fluid = *components_.fluid;
  auto& coupling = *components_.coupling;
  const bool has_no_divergence = fluid.begin_advection_velocity(dt);
  if (components_.solids->empty() && last_dt_ > 0 && !fluid_moved_ && has_no_divergence)
    return;
  ScopedStage stage(timers_, "F2");
  const std::vector<double> effective = coupling.effective_velocity(*components_.solids);
  fluid.set_coupled_velocity(effective);
  BlockVector rhs{make_vector(fluid.pressure_map()), Teuchos::null}, solution;
  fluid.divergence(*rhs.pressure);
  coupling.add_divergence(effective, *rhs.pressure);
  const BlockSystem& blocks = system_.blocks(0, false);
  report.incompatibility_f2 = relative_part_removed(blocks.null_space, *rhs.pressure);
  solution.pressure = make_vector(fluid.pressure_map());
  components_.strategy->prepare(blocks);
  const std::vector<double> gas_pressure =
      solve_advection(dt, effective, blocks, rhs, solution, report.f2);
  project(*solution.pressure, gas_pressure);
}

/// F3 but for the forces: along the rays of u_ADV, to the geometry of t^{n+1}.
template <int dim>
void Stepper<dim>::advect(double dt, StepReport<dim>& report) {
  ScopedStage stage(timers_, "F3 advection");
  auto& fluid = *components_.fluid;
  const auto& solids = *components_.solids;
  const std::shared_ptr<const SurfaceSnapshot<dim>> before = system_.surface();
  const bool stays =
      frozen_at_rest_ && solids_rest() && (solids.empty() || solids.is_where(*before));
  const auto after = stays || solids.empty() ? before : solids.snapshot();
  const MovingSurface<dim> moving{before, after, [&solids](const SurfacePoint<dim>& point) {
                                    return solids.effective_velocity(point, point.position);
                                  }};
  fluid.advect(time_, dt, moving);
  {
    ScopedStage geometry(timers_, "geometry");
    if (!stays || fluid.geometry_changes())
      freeze(after);
  }
  fluid.revalidate(moving);
  reset_unseen_faces();
  report.ledger.open(total_momentum(fluid_momentum()));
  report.transport_change = report.ledger.before() - last_momentum_;
  if (energy_)
    energy_->end_transport();
}

template void Stepper<2>::reset_unseen_faces();
template Prediction<2> Stepper<2>::predict_forces(const StepContext<2>&, StepReport<2>&);
template void Stepper<2>::make_advection_velocity(double, StepReport<2>&);
template void Stepper<2>::advect(double, StepReport<2>&);
template void Stepper<3>::reset_unseen_faces();
template Prediction<3> Stepper<3>::predict_forces(const StepContext<3>&, StepReport<3>&);
template void Stepper<3>::make_advection_velocity(double, StepReport<3>&);
template void Stepper<3>::advect(double, StepReport<3>&);

}  // namespace lockstep
