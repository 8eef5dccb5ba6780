#include "stepping/step/prediction.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>
#include <cmath>

#include "base/errors.hpp"
#include "interfaces/liquid.hpp"

namespace lockstep {

template <int dim>
Prediction<dim>::Prediction(Components<dim>& components, CoupledSystem<dim>& system,
                            CoupledSolve<dim>& solve, const PredictionOptions& options,
                            StageTimers& timers)
    : components_(components),
      sides_(components),
      system_(system),
      solve_(solve),
      solid_forces_(components, system),
      gas_(components),
      options_(options),
      timers_(timers) {
  check_input(
      !sides_.viscous_fluid || sides_.viscous_coupling,
      "The coupling \"{}\" carries no viscous forces, but the fluid is viscous; take another "
      "one, or make the fluid inviscid.",
      components.coupling->name());
}

template <int dim>
FluidForces<dim> Prediction<dim>::add_forces(const StepContext<dim>& context) {
  ScopedStage stage(timers_, "forces");
  auto& fluid = *components_.fluid;
  const ForceImpulse<dim> given = fluid.add_forces(context.begin, context.dt);
  FluidForces<dim> forces;
  if (context.moves_positions)
    return forces;
  if (const auto* liquid = fluid.liquid())
    forces.tension = liquid->surface_impulse();
  forces.body = given.impulse + system_.lumped_fluid_momentum(given.coupled_change) -
                forces.tension.value_or(Momentum<dim>());
  return forces;
}

template <int dim>
Friction<dim> Prediction<dim>::add_viscosity(const StepContext<dim>& context,
                                             const FluidForces<dim>& forces) {
  if (!sides_.viscous_fluid)
    return {};
  Expected expected;
  if (options_.incremental_pressure || sides_.viscous_fluid->wants_present_pressure())
    expected = expected_pressure(context);
  ScopedStage stage(timers_, "viscosity");
  Friction<dim> friction = solve(context, expected);
  if (forces.tension)
    friction.tension = components_.fluid->liquid()->surface_impulse() - *forces.tension;
  return friction;
}

/// p̂ of fluid and bubbles of gas in the last step. In the first two steps that of a solve without
/// viscosity: what the first step's pressure did to velocities that were no flow at the start is an
/// impulse, and comes once. A fluid may ask for the latter in every step.
template <int dim>
typename Prediction<dim>::Expected Prediction<dim>::expected_pressure(
    const StepContext<dim>& context) {
  if (context.step.number > 2 && !sides_.viscous_fluid->wants_present_pressure())
    return {last_pressure(*components_.fluid, context.step, context.dt),
            gas_.expected_pressure(context.dt),
            {}};
  const CoupledSolution solution =
      solve_.solve(context, solid_forces_.momentum(context).momentum, "first pressure");
  return {solution.unknowns.pressure, solution.gas_pressure, solution.report};
}

/// Row 2 of the viscous system without unknowns' offsets: M_S V_S* + W^T M_F u*_F and the impulses
/// of the expected pressure. Null without unknowns.
template <int dim>
RCP<Vector> Prediction<dim>::solid_row(const StepContext<dim>& context, const Expected& expected) {
  if (!components_.solids->has_unknowns())
    return Teuchos::null;
  const RCP<Vector> momentum = solid_forces_.own_momentum(context);
  if (!expected.of_fluid.is_null() && sides_.hydrostatic_coupling)
    sides_.hydrostatic_coupling->add_hydrostatic_force(context.dt, *momentum);
  const RCP<Vector> row = system_.lumped_momentum(*momentum);
  if (!expected.of_fluid.is_null())
    components_.coupling->coupling_transposed()->apply(*expected.of_fluid, *row, Teuchos::NO_TRANS,
                                                       -1, 1);
  // Solids that feel the pressure here feel what contact answers to it, too.
  if (!expected.of_fluid.is_null() && solve_.holds_contacts())
    solve_.hold(solve_.expected_contacts(context, *solid_forces_.momentum(context).momentum,
                                         solve_.contact_response(context.dt)),
                *row);
  system_.subtract_given(context.dt, context.constraints, *row);
  if (!expected.of_gas.empty())
    sides_.gas_coupling->add_gas_push(expected.of_gas, *row);
  return row;
}

template <int dim>
Friction<dim> Prediction<dim>::solve(const StepContext<dim>& context, const Expected& expected) {
  const double dt = context.dt;
  const auto& fluid = *components_.fluid;
  const RCP<Vector> row = solid_row(context, expected);
  RCP<const LinearOperator> block;
  NearNullSpace near_null_space;
  if (components_.solids->has_unknowns()) {
    const BlockSystem& blocks = system_.blocks(dt);
    block = blocks.solid_block();
    near_null_space = blocks.near_null_space;
  }
  if (!expected.of_fluid.is_null())
    gas_.project(*expected.of_fluid, expected.of_gas);
  const std::unique_ptr<ViscousSystem<dim>> viscous = sides_.viscous_fluid->viscous_system();
  Friction<dim> friction;
  friction.pressure_work = expected.work;
  friction.viscous =
      solve_viscous<dim>({*viscous, *sides_.viscous_fluid, *components_.solids,
                          *sides_.viscous_coupling, block, near_null_space},
                         {row, dt, context.constraints, options_.viscous, !context.moves_positions,
                          options_.surface_forces && !context.moves_positions});
  system_.hold(Teuchos::null);
  const double full_mass = viscous->mass->normInf();
  if (full_mass > 0)
    friction.viscous_number =
        viscous->viscosity * dt * std::pow(fluid.smallest_length(), dim - 2) / full_mass;
  if (options_.rotational_pressure)
    friction.pressure = viscous_pressure(viscous->viscosity, dt, friction.viscous.solid_velocity);
  if (!expected.of_fluid.is_null()) {
    Vector back(*expected.of_fluid, Teuchos::Copy);
    back.scale(-1);
    std::vector<double> gas_back = expected.of_gas;
    for (double& value : gas_back)
      value = -value;
    gas_.project(back, gas_back);
  }
  return friction;
}

/// Part of the pressure that the projection of a velocity that feels pressure and viscosity leaves
/// out, -mu div u' (Timmermans, Minev and van de Vosse 1996). The projection alone finds a pressure
/// that answers to inertia; where nu dt > h^2 viscosity answers first, and without this part the
/// pressure would need nu dt / h^2 steps to follow. Where a cell is cut it is less than it might
/// be.
template <int dim>
RCP<Vector> Prediction<dim>::viscous_pressure(double viscosity, double dt,
                                              const RCP<const Vector>& velocity) {
  auto& fluid = *components_.fluid;
  auto& coupling = *components_.coupling;
  const auto result = make_vector(fluid.pressure_map());
  fluid.divergence(*result);
  coupling.add_prescribed_divergence(*result);
  if (components_.solids->has_unknowns())
    coupling.coupling_transposed()->apply(*velocity, *result, Teuchos::TRANS, 1, 1);
  result->scale(dt * viscosity);
  return result;
}

template class Prediction<2>;
template class Prediction<3>;

}  // namespace lockstep
