#include "stepping/stepper.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>
#include <cmath>

#include "base/errors.hpp"
#include "linear/null_space.hpp"
#include "solve/soft/exact_inverse.hpp"

namespace lockstep {

template <int dim>
Stepper<dim>::Stepper(Components<dim>& components, const StepperOptions& options, double start_time,
                      StageTimers& timers)
    : components_(components),
      sides_(components),
      options_(options),
      timers_(timers),
      system_(*components.fluid, *components.solids, *components.coupling),
      time_(start_time) {
  check_input(
      !sides_.viscous_fluid || sides_.viscous_coupling,
      "The coupling \"{}\" carries no viscous forces, but the fluid is viscous; take another "
      "one, or make the fluid inviscid.",
      components.coupling->name());
  check_input(!sides_.gas_fluid || !sides_.gas_fluid->holds_gas() || sides_.gas_coupling,
              "The coupling \"{}\" knows no gas that pushes on solids; take another one, or leave "
              "\"Trapped Air\" at \"void\".",
              components.coupling->name());
  freeze();
  // Motions that begin at rest do so but for round-off.
  const double negligible = 1e-12 * components_.fluid->fluid_volume();  // a second
  const std::string impossible =
      system_.impossible_flow(time_, components_.solids->constraints(time_, time_), negligible);
  check_input(impossible.empty(), "At the start: {}", impossible);
  if (options.energy_book)
    energy_.emplace(components, system_);
}

template <int dim>
void Stepper<dim>::freeze() {
  freeze(components_.solids->snapshot());
  components_.fluid->begin_prediction();
  last_momentum_ = total_momentum(fluid_momentum());
}

template <int dim>
void Stepper<dim>::freeze(const std::shared_ptr<const SurfaceSnapshot<dim>>& surface) {
  system_.freeze(surface);
  frozen_at_rest_ = solids_rest();
}

/// Nothing moves them now, nor has them ready to move.
template <int dim>
bool Stepper<dim>::solids_rest() const {
  return !coupled() && components_.solids->largest_surface_speed() == 0;
}

template <int dim>
void Stepper<dim>::make_room(double dt) {
  const auto& solids = *components_.solids;
  fluid_moved_ = components_.fluid->begin_step(
      time_, dt, [&solids] { return solids.largest_surface_speed(); });
  if (!fluid_moved_)
    return;
  // What is lost with cells that are gone counts as carried away.
  const Momentum<dim> before = last_momentum_;
  freeze();
  last_momentum_ = before;
}

/// On the dynamic solids. Users see it, and that on prescribed solids, among the forces of the
/// fluid.
template <int dim>
RCP<const Vector> Stepper<dim>::unseen_buoyancy(double dt, StepReport<dim>& report) const {
  const auto& solids = *components_.solids;
  const auto buoyancy = make_vector(solids.map());
  report.hydrodynamic_impulse.assign(solids.solids().size(), {});
  if (sides_.unseen_buoyancy)
    report.hydrodynamic_impulse =
        sides_.unseen_buoyancy->add_unseen_buoyancy(components_.fluid->gravity(), dt, *buoyancy);
  add_each(solids.momentum_of_each(*buoyancy), report.hydrodynamic_impulse);
  return buoyancy;
}

/// Of the solids, and of what joints gave where the step began.
template <int dim>
RCP<Vector> Stepper<dim>::explicit_momentum(const StepContext<dim>& context) const {
  const RCP<Vector> momentum = components_.solids->explicit_momentum(context.time, context.dt);
  if (!context.joints.given.is_null())
    momentum->update(1, *context.joints.given, 1);
  return momentum;
}

/// M_S V_S*: explicit forces, buoyancy the grid does not see, contact, viscous drag. `correction`:
/// where positions are moved, in the place of the solids' own; null: that.
template <int dim>
RCP<Vector> Stepper<dim>::solid_momentum(const StepContext<dim>& context,
                                         const Prediction<dim>& prediction, StepReport<dim>& report,
                                         const RCP<const Vector>& correction) {
  auto& solids = *components_.solids;
  const double dt = context.dt;
  const RCP<Vector> momentum = explicit_momentum(context);
  if (context.moves_positions())
    momentum->update(1, correction.is_null() ? *midpoint_correction(dt) : *correction, 1);
  const RCP<const Vector> buoyancy = unseen_buoyancy(dt, report);
  momentum->update(1, *buoyancy, 1);
  if (context.ledger) {
    context.ledger->add("solid forces", solids.external_impulse(context.time, dt));
    context.ledger->add("unseen buoyancy", solids.momentum(*buoyancy));
    if (!context.joints.given.is_null())
      context.ledger->add("joints", solids.momentum(*context.joints.given));
  }
  if (!context.moves_positions())
    add_drops(context, *momentum, report);
  if (context.stage == Stage::S2 && components_.contact) {
    ScopedStage stage(timers_, "contact");
    report.contact_velocity = contact_momentum(context, *momentum);
    if (context.ledger)
      context.ledger->add("contact", report.contact_velocity.external_impulse);
  }
  if (!prediction.viscous.solid_impulse.is_null())
    momentum->update(1, *prediction.viscous.solid_impulse, 1);
  return momentum;
}

/// Springs of joints are stiff: they answer what contact and limits do within the step. Without
/// them solids answer with their masses.
template <int dim>
ContactResponse Stepper<dim>::contact_response(double dt) const {
  const auto& solids = *components_.solids;
  if (!solids.joints() || !solids.joints()->has_implicit_forces())
    return {};
  return [&solids, dt, inverse = RCP<const LinearOperator>()]() mutable {
    if (inverse.is_null())
      inverse = exact_inverse(solids.solid_block(Teuchos::null, dt), "implicit forces of joints");
    return inverse;
  };
}

/// Contact acts on V_S* = M_S^-1 momentum; its impulses go into the momentum.
template <int dim>
ContactReport<dim> Stepper<dim>::contact_momentum(const StepContext<dim>& context,
                                                  Vector& momentum) {
  auto& solids = *components_.solids;
  if (solids.has_implicit_forces())
    return settled_momentum(context, momentum);
  const ContactResponse response = contact_response(context.dt);
  const RCP<Vector> velocity =
      response ? solids.velocity_of(momentum, context.dt, context.constraints, *response())
               : solids.velocity_of(momentum, 0, context.constraints);
  Vector change(*velocity, Teuchos::Copy);
  const ContactReport<dim> report =
      components_.contact->resolve(solids, ContactPhase::velocity, context.dt, *velocity, response);
  if (!report.impulse.is_null()) {
    momentum.update(1, *report.impulse, 1);
  } else if (report.n_contacts > 0) {
    change.update(1, *velocity, -1);
    apply(*solids.mass(), change, momentum, 1, 1);
  }
  return report;
}

/// p̂ = dt p of the last step's pressure p; zero before the first one.
template <int dim>
RCP<Vector> Stepper<dim>::last_pressure(double dt) const {
  const RCP<Vector> pressure = last_scaled_pressure_of(*components_.fluid);
  if (last_dt_ > 0)
    pressure->scale(dt / last_dt_);
  return pressure;
}

/// Begins at what a solve of nearly the same found, if there was one, else at the last step's.
template <int dim>
CoupledSolution Stepper<dim>::solve(const StepContext<dim>& context, const RCP<Vector>& momentum,
                                    const std::string& name, SolveReport& report,
                                    double& incompatibility, const BlockVector* nearby) {
  const Reduction& constraints = context.constraints;
  CoupledSolution solution;
  solution.momentum = momentum;
  solution.coupled_before = components_.fluid->coupled_velocity();
  {
    ScopedStage stage(timers_, "right-hand side");
    solution.rhs = system_.right_hand_side(*momentum, context.dt, constraints, incompatibility);
  }
  const BlockSystem& blocks = system_.blocks(context.dt);
  solution.unknowns.pressure =
      nearby ? rcp(new Vector(*nearby->pressure, Teuchos::Copy)) : last_pressure(context.dt);
  project_out(blocks.null_space, *solution.unknowns.pressure);
  if (coupled()) {
    solution.unknowns.solid =
        nearby ? rcp(new Vector(*nearby->solid, Teuchos::Copy)) : components_.solids->velocity();
    constraints.select(*solution.unknowns.solid);
  }
  {
    ScopedStage stage(timers_, "preconditioner");
    components_.strategy->prepare(blocks);
  }
  ScopedStage stage(timers_, "iterations");
  solve_coupled(context, blocks, request(name, context.dt), solution, report);
  solution.velocity = coupled() ? solution.unknowns.solid : make_vector(components_.solids->map());
  if (!constraints.is_identity()) {
    solution.velocity = rcp(new Vector(*solution.velocity, Teuchos::Copy));
    constraints.expand(*solution.velocity);
  }
  return solution;
}

/// Residuals below the round-off of the fluxes, with the speed that gravity may add, are nothing:
/// in each cell a few bits of what passes a face, in the norm over all cells root of their number
/// as much.
template <int dim>
SolveRequest Stepper<dim>::request(const std::string& name, double dt) const {
  const auto& fluid = *components_.fluid;
  const double speed = fluid.largest_speed() + dt * fluid.gravity().norm();
  const double area = std::pow(fluid.smallest_length(), dim - 1);
  const auto n_cells = static_cast<double>(fluid.pressure_map()->getGlobalNumElements());
  return {name, options_.tolerance, 1e-15 * speed * area * std::sqrt(n_cells), n_steps_ + 1};
}

/// Of u*.
template <int dim>
Momentum<dim> Stepper<dim>::fluid_momentum() const {
  return sides_.audited_fluid ? sides_.audited_fluid->momentum() : Momentum<dim>();
}

/// Fluid (u*), lumped fluid and solids (M_S V_S^n).
template <int dim>
Momentum<dim> Stepper<dim>::total_momentum(const Momentum<dim>& of_fluid) const {
  Momentum<dim> total = of_fluid;
  total += system_.lumped_fluid_momentum(components_.fluid->coupled_velocity());
  if (coupled())
    total += components_.solids->momentum(*components_.solids->explicit_momentum(time_, 0));
  return total;
}

/// What is prescribed at the end of the step must have a solution, but for what the grid makes of
/// the solids' shapes.
template <int dim>
void Stepper<dim>::check_possible(const StepContext<dim>& context, double incompatibility) const {
  constexpr double round_off = 1e-9;
  if (incompatibility <= round_off)
    return;
  const double end = context.time + context.step_dt;
  const std::string impossible = system_.impossible_flow(end, context.constraints);
  check_solve(impossible.empty(), "At {:.6g} s: {}", end, impossible);
}

/// What they gave in this step: contact acts before S2, which finds what is left.
template <int dim>
void Stepper<dim>::tell_joints(const StepContext<dim>& context, const StepReport<dim>& report) {
  auto& solids = *components_.solids;
  if (!solids.joints() || report.reactions.is_null())
    return;
  Vector reactions(*report.reactions, Teuchos::Copy);
  if (!report.contact_velocity.reactions.is_null())
    reactions.update(1, *report.contact_velocity.reactions, 1);
  solids.joints()->take_note({context.joints.held, solids.reduction().on_given(reactions),
                              report.contact_velocity.limit_impulses},
                             context.time, context.dt);
}

/// F4 and the end of the audit.
template <int dim>
void Stepper<dim>::finish(const Solved& solved, StepReport<dim>& report) {
  const auto& [context, prediction, solution] = solved;
  auto& fluid = *components_.fluid;
  auto& solids = *components_.solids;
  report.max_divergence =
      largest_divergence(system_.blocks(context.dt), solution, fluid.smallest_length(), dim);
  audit_solve<dim>(components_, sides_, system_, context, solution, prediction.viscous, report);
  project(*solution.unknowns.pressure, solution.gas_pressure);
  if (!prediction.pressure.is_null() && sides_.pressure_memory)
    sides_.pressure_memory->correct_pressure(*prediction.pressure);
  const std::vector<double> coupled_after = components_.coupling->velocity(*solution.velocity);
  fluid.set_coupled_velocity(coupled_after);
  if (energy_)
    energy_->end_solve(context, solution, prediction.viscous.solid_impulse, report.reactions);
  fluid.accept();

  const Momentum<dim> of_fluid = fluid_momentum();
  report.fluid_momentum = of_fluid + system_.lumped_fluid_momentum(coupled_after);
  report.fluid_kinetic_energy = system_.lumped_fluid_energy(coupled_after);
  if (sides_.audited_fluid)
    report.fluid_kinetic_energy += sides_.audited_fluid->kinetic_energy();
  report.fluid_volume = fluid.fluid_volume();
  if (const LiquidFluid<dim>* liquid = liquid_of<dim>(fluid)) {
    report.liquid = liquid->liquid();
    report.fluid_volume = report.liquid->volume;
  }
  if (coupled()) {
    solids.set_velocity(*solution.velocity);
    const auto after = make_vector(solids.map());
    apply(*solids.mass(), *solution.velocity, *after);
    report.solid_momentum = solids.momentum(*after);
    tell_joints(context, report);
  }
  report.n_clamped_elements = solids.n_clamped_elements();
  report.ledger.close(report.fluid_momentum + report.solid_momentum);
  // Not that of the ledger: a restarted run finds it anew, and must not differ in its last digit.
  last_momentum_ = total_momentum(of_fluid);
  audit_momentum<dim>(components_, sides_, report);
  for (const auto& state : solids.states()) {
    report.solid_kinetic_energy += state.kinetic_energy;
    report.elastic_energy += state.elastic_energy;
  }
  if (energy_)
    report.energy = energy_->end(report.time, report.dt);
}

template <int dim>
StepReport<dim> Stepper<dim>::advance(double dt, const std::function<void()>& between_stages) {
  make_room(dt);
  StepReport<dim> report;
  const Solved solved = solve_step(dt, between_stages, report);
  between_stages();
  {
    ScopedStage stage(timers_, "end");
    finish(solved, report);  // F4
  }
  time_ += dt;
  last_dt_ = dt;
  ++n_steps_;
  return report;
}

/// F1 and S1: mean velocities of held dofs over the step, so that positions follow their scripts.
template <int dim>
StepContext<dim> Stepper<dim>::context_of_positions(double dt) const {
  return {Stage::F1, time_, dt, dt / 2, components_.solids->constraints(time_, time_ + dt)};
}

/// F3 and S2: those at the end of the step.
template <int dim>
StepContext<dim> Stepper<dim>::context_of_velocities(double dt, MomentumLedger<dim>& ledger,
                                                     const StartImpulse& joints) const {
  const double end = time_ + dt;
  return {Stage::F3, time_, dt, dt, components_.solids->constraints(end, end), &ledger, joints};
}

template <int dim>
typename Stepper<dim>::Solved Stepper<dim>::solve_step(double dt,
                                                       const std::function<void()>& between_stages,
                                                       StepReport<dim>& report) {
  auto& fluid = *components_.fluid;
  auto& solids = *components_.solids;
  report.dt = dt;
  report.time = time_ + dt;
  report.cfl = dt * fluid.largest_speed() / fluid.smallest_length();
  if (solids.begin_step(time_, dt))
    freeze();  // other dofs are unknowns now
  if (components_.contact)
    components_.contact->begin_step(time_);
  if (energy_)
    energy_->begin();

  StepContext<dim> context = context_of_positions(dt);
  Prediction<dim> prediction;
  if (coupled()) {  // F1 serves S1 only
    ScopedStage stage(timers_, "F1");
    fluid.begin_prediction();
    reset_unseen_faces();
    prediction = predict_forces(context, report);
  }
  between_stages();
  const StartImpulse joints = move_solids(context.in(Stage::S1), prediction, report);  // S1
  report.s1.add_work(prediction.pressure_work);
  between_stages();
  make_advection_velocity(dt, report);  // F2
  between_stages();
  advect(dt, report);  // F3
  between_stages();
  context = context_of_velocities(dt, report.ledger, joints);
  {
    ScopedStage stage(timers_, "F3 forces");
    prediction = predict_forces(context, report);
  }
  if (energy_)
    energy_->end_friction();
  between_stages();
  ScopedStage stage(timers_, "S2");
  context.stage = Stage::S2;
  RCP<Vector> momentum = make_vector(solids.map());
  if (coupled()) {
    momentum = solid_momentum(context, prediction, report);
  } else {
    unseen_buoyancy(dt, report);
    add_drops(context, *momentum, report);
  }
  CoupledSolution solution = solve_settled(context, momentum, report);
  report.s2.add_work(prediction.pressure_work);
  check_possible(context, report.incompatibility_s2);
  return {context, prediction, solution};
}

template class Stepper<2>;
template class Stepper<3>;

}  // namespace lockstep
