#include "stepping/stepper.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>
#include <cmath>

#include "base/errors.hpp"
#include "base/interruption.hpp"
#include "coupling/swept_volumes.hpp"
#include "linear/null_space.hpp"
#include "stepping/implicit_motion.hpp"
#include "stepping/solve_audit.hpp"

namespace lockstep {

template <int dim>
Stepper<dim>::Stepper(Components<dim>& components, const StepperOptions& options, double start_time,
                      PhaseTimers& timers)
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
  freeze();
  // Motions that begin at rest do so but for round-off.
  const double negligible = 1e-12 * components_.fluid->fluid_volume();  // a second
  const std::string impossible =
      system_.impossible_flow(time_, components_.solids->locked_velocity(time_, time_), negligible);
  check_input(impossible.empty(), "At the start: {}", impossible);
}

template <int dim>
void Stepper<dim>::resume(double time, double last_dt) {
  time_ = time;
  last_dt_ = last_dt;
  components_.solids->begin_step(time, 0);
  freeze();
}

template <int dim>
void Stepper<dim>::freeze() {
  system_.freeze(components_.solids->snapshot());
  components_.fluid->begin_prediction();
  last_momentum_ = total_momentum();
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

/// M_S V_S*: explicit forces, buoyancy the grid does not see, contact, viscous drag.
template <int dim>
RCP<Vector> Stepper<dim>::solid_momentum(double time, double dt, MomentumLedger<dim>* ledger,
                                         StepReport<dim>& report) {
  auto& solids = *components_.solids;
  const RCP<Vector> momentum = solids.explicit_momentum(time, dt);
  if (!ledger)  // S1
    solids.add_midpoint_correction(dt, resolved_part(dt), *momentum);
  if (ledger)
    ledger->add("solid forces", solids.external_impulse(time, dt));
  const RCP<const Vector> buoyancy = unseen_buoyancy(dt, report);
  momentum->update(1, *buoyancy, 1);
  if (ledger)
    ledger->add("unseen buoyancy", solids.momentum(*buoyancy));
  if (ledger && components_.contact) {
    ScopedPhase phase(timers_, "contact");
    report.contact_velocity = contact_momentum(dt, *momentum);
    ledger->add("contact", report.contact_velocity.external_impulse);
  }
  if (!viscous_.solid_impulse.is_null())
    momentum->update(1, *viscous_.solid_impulse, 1);
  return momentum;
}

/// The velocities of the locked dofs put in.
template <int dim>
RCP<Vector> Stepper<dim>::at_locked_velocity(const Vector& velocity) const {
  const auto result = make_vector(components_.solids->map());
  result->elementWiseMultiply(1, *components_.solids->free_mask(), velocity, 0);
  if (!locked_velocity_.is_null())
    result->update(1, *locked_velocity_, 1);
  return result;
}

/// Contact acts on V_S* = M_S^-1 momentum; its impulses go into the momentum.
template <int dim>
ContactReport<dim> Stepper<dim>::contact_momentum(double dt, Vector& momentum) {
  auto& solids = *components_.solids;
  if (solids.has_implicit_forces())
    return settled_momentum(dt, momentum);
  const RCP<Vector> velocity = at_locked_velocity(*solids.velocity_of(momentum));
  Vector change(*velocity, Teuchos::Copy);
  const ContactReport<dim> report =
      components_.contact->resolve(solids, ContactPhase::velocity, dt, *velocity);
  if (report.n_contacts > 0) {
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

template <int dim>
CoupledSolution Stepper<dim>::solve(double dt, const RCP<Vector>& momentum, const char* name,
                                    SolveReport& report, double& incompatibility) {
  CoupledSolution solution;
  solution.momentum = momentum;
  solution.coupled_before = components_.fluid->coupled_velocity();
  {
    ScopedPhase phase(timers_, "right-hand side");
    solution.rhs = system_.right_hand_side(*momentum, incompatibility, dt, locked_velocity_);
  }
  const BlockSystem& blocks = system_.blocks(dt);
  solution.unknowns.pressure = last_pressure(dt);
  project_out(blocks.null_space, *solution.unknowns.pressure);
  if (coupled()) {
    solution.unknowns.solid = make_vector(components_.solids->map());
    solution.unknowns.solid->elementWiseMultiply(1, *components_.solids->free_mask(),
                                                 *components_.solids->velocity(), 0);
  }
  {
    ScopedPhase phase(timers_, "preconditioner");
    components_.strategy->prepare(blocks);
  }
  ScopedPhase phase(timers_, "iterations");
  report = components_.strategy->solve(blocks, solution.rhs, solution.unknowns, request(name, dt));
  if (coupled() && !locked_velocity_.is_null())
    solution.unknowns.solid->update(1, *locked_velocity_, 1);
  return solution;
}

/// Newton's method on the elastic forces at the positions that the solution reaches: every
/// iteration is a coupled solve, whose explicit momentum differs from the last one's by theirs.
template <int dim>
CoupledSolution Stepper<dim>::solve_newton(double dt, const RCP<Vector>& momentum, const char* name,
                                           SolveReport& report, double& incompatibility) {
  auto& solids = *components_.solids;
  CoupledSolution solution = solve(dt, momentum, name, report, incompatibility);
  for (int k = 1; k < options_.newton_iterations && coupled(); ++k) {
    const RCP<const Vector> before = solids.explicit_momentum(time_, dt);
    if (!solids.linearise(dt, *solution.unknowns.solid))
      break;
    system_.forget_solid_block();
    momentum->update(1, *solids.explicit_momentum(time_, dt), -1, *before, 1);
    const int iterations = report.iterations;
    solution = solve(dt, momentum, name, report, incompatibility);
    report.iterations += iterations;
  }
  return solution;
}

/// Residuals below the round-off of the fluxes, with the speed that gravity may add, are nothing:
/// in each cell a few bits of what passes a face, in the norm over all cells root of their number
/// as much.
template <int dim>
SolveRequest Stepper<dim>::request(const char* name, double dt) const {
  const auto& fluid = *components_.fluid;
  const double speed = fluid.largest_speed() + dt * fluid.gravity().norm();
  const double area = std::pow(fluid.smallest_length(), dim - 1);
  const auto n_cells = static_cast<double>(fluid.pressure_map()->getGlobalNumElements());
  return {name, options_.tolerance, 1e-15 * speed * area * std::sqrt(n_cells)};
}

/// Soft solids keep the volumes of closed regions, contact acts on V^{n+1/2}, then all solids go to
/// their positions at t^{n+1}.
template <int dim>
void Stepper<dim>::move_solids(double dt, StepReport<dim>& report) {
  auto& solids = *components_.solids;
  RCP<Vector> half_velocity = make_vector(solids.map());
  SweptRates swept;
  RCP<Vector> momentum;
  if (coupled()) {
    ScopedPhase phase(timers_, "S1");
    momentum = solid_momentum(time_, dt / 2, nullptr, report);
    half_velocity =
        solve_newton(dt / 2, momentum, "S1", report.s1, report.incompatibility_s1).unknowns.solid;
    swept = swept_rates(*components_.fluid, solids, *components_.coupling, *half_velocity);
  }
  ScopedPhase phase(timers_, "solid motion");
  solids.limit_motion(dt, *half_velocity);
  // Shells push the fluid of closed regions, bodies only take back what straight steps add.
  const auto sweep_shells = [&](Vector& velocity) {
    sweep_volumes(rates_of_kind(swept, solids, false), solids, dt, velocity);
  };
  sweep_shells(*half_velocity);
  const Vector as_solved(*half_velocity, Teuchos::Copy);
  sweep_volumes(rates_of_kind(swept, solids, true), solids, dt, *half_velocity);
  if (coupled() && solids.has_implicit_forces())
    bound_sweep<dim>(solids, dt / 2, as_solved, *half_velocity);
  if (coupled() && solids.has_implicit_forces()) {
    const SettledMotion<dim> settled =
        settle_motion(solids, components_.contact.get(),
                      {ContactPhase::position, time_, dt / 2, dt, locked_velocity_, sweep_shells},
                      as_solved, *half_velocity, *momentum);
    half_velocity = settled.velocity;
    report.contact_position = settled.contact;
  } else if (components_.contact && coupled()) {
    report.contact_position =
        components_.contact->resolve(solids, ContactPhase::position, dt, *half_velocity);
  }
  solids.move(*half_velocity, time_, dt);
}

/// F2: u_ADV from u^n with the effective solid velocity as Neumann data.
template <int dim>
void Stepper<dim>::make_advection_velocity(StepReport<dim>& report) {
  auto& fluid = *components_.fluid;
  auto& coupling = *components_.coupling;
  fluid.begin_advection_velocity(report.dt);
  if (components_.solids->empty() && last_dt_ > 0)
    return;  // u^n is divergence-free already
  ScopedPhase phase(timers_, "F2");
  const std::vector<double> effective = coupling.effective_velocity(*components_.solids);
  fluid.set_coupled_velocity(effective);
  BlockVector rhs{make_vector(fluid.pressure_map()), Teuchos::null}, solution;
  fluid.divergence(*rhs.pressure);
  coupling.add_divergence(effective, *rhs.pressure);
  const BlockSystem& blocks = system_.blocks(0, false);
  report.incompatibility_f2 = relative_part_removed(blocks.null_space, *rhs.pressure);
  solution.pressure = make_vector(fluid.pressure_map());
  components_.strategy->prepare(blocks);
  report.f2 = components_.strategy->solve(blocks, rhs, solution, request("F2", report.dt));
  fluid.project(*solution.pressure);
}

/// Of u*.
template <int dim>
Momentum<dim> Stepper<dim>::fluid_momentum() const {
  return sides_.audited_fluid ? sides_.audited_fluid->momentum() : Momentum<dim>();
}

/// Fluid (u*), lumped fluid and solids (M_S V_S^n).
template <int dim>
Momentum<dim> Stepper<dim>::total_momentum() const {
  Momentum<dim> total = fluid_momentum();
  total += system_.lumped_fluid_momentum(components_.fluid->coupled_velocity());
  if (coupled())
    total += components_.solids->momentum(*components_.solids->explicit_momentum(time_, 0));
  return total;
}

/// What is prescribed at the end of the step must have a solution, but for what the grid makes of
/// the solids' shapes.
template <int dim>
void Stepper<dim>::check_possible(double dt, double incompatibility) const {
  constexpr double round_off = 1e-9;
  if (incompatibility <= round_off)
    return;
  const std::string impossible = system_.impossible_flow(time_ + dt, locked_velocity_);
  check_solve(impossible.empty(), "At {:.6g} s: {}", time_ + dt, impossible);
}

/// F4 and the end of the audit.
template <int dim>
void Stepper<dim>::finish(const CoupledSolution& solution, double dt, StepReport<dim>& report) {
  auto& fluid = *components_.fluid;
  auto& solids = *components_.solids;
  const BlockVector& unknowns = solution.unknowns;
  report.max_divergence =
      largest_divergence(system_.blocks(dt), solution, fluid.smallest_length(), dim);
  audit_solve<dim>(components_, sides_, system_, solution, viscous_, dt, report);
  fluid.project(*unknowns.pressure);
  if (!viscous_pressure_.is_null() && sides_.pressure_memory)
    sides_.pressure_memory->correct_pressure(*viscous_pressure_);
  RCP<Vector> velocity = unknowns.solid;
  if (velocity.is_null())
    velocity = make_vector(solids.map());
  const std::vector<double> coupled_after = components_.coupling->velocity(*velocity);
  fluid.set_coupled_velocity(coupled_after);
  fluid.accept();

  report.fluid_momentum = fluid_momentum() + system_.lumped_fluid_momentum(coupled_after);
  report.fluid_kinetic_energy = system_.lumped_fluid_energy(coupled_after);
  if (sides_.audited_fluid)
    report.fluid_kinetic_energy += sides_.audited_fluid->kinetic_energy();
  report.fluid_volume = fluid.fluid_volume();
  if (coupled()) {
    solids.set_velocity(*velocity);
    const auto after = make_vector(solids.map());
    apply(*solids.mass(), *velocity, *after);
    report.solid_momentum = solids.momentum(*after);
  }
  report.n_clamped_elements = solids.n_clamped_elements();
  report.ledger.close(report.fluid_momentum + report.solid_momentum);
  // Not that of the ledger: a restarted run finds it anew, and must not differ in its last digit.
  last_momentum_ = total_momentum();
  audit_momentum<dim>(components_, sides_, report);
  for (const auto& state : solids.states()) {
    report.solid_kinetic_energy += state.kinetic_energy;
    report.elastic_energy += state.elastic_energy;
  }
}

template <int dim>
StepReport<dim> Stepper<dim>::advance(double dt) {
  const std::function<void()> undo = undo_of(components_);
  StepReport<dim> report;
  try {
    const CoupledSolution solution = solve_step(dt, report);
    ScopedPhase phase(timers_, "end");
    finish(solution, dt, report);
  } catch (const Interrupted&) {
    undo();
    throw;
  }
  time_ += dt;
  last_dt_ = dt;
  return report;
}

template <int dim>
CoupledSolution Stepper<dim>::solve_step(double dt, StepReport<dim>& report) {
  const Interruptible interruptible;
  auto& fluid = *components_.fluid;
  auto& solids = *components_.solids;
  report.dt = dt;
  report.time = time_ + dt;
  report.cfl = dt * fluid.largest_speed() / fluid.smallest_length();
  if (solids.begin_step(time_, dt))
    freeze();                    // other dofs are locked now
  system_.forget_solid_block();  // what is implicit is other in S1 than in S2
  locked_velocity_ = solids.locked_velocity(time_, time_ + dt);
  const std::shared_ptr<const SurfaceSnapshot<dim>> before = system_.surface();

  if (coupled()) {  // F1 serves S1 only
    ScopedPhase phase(timers_, "F1");
    fluid.begin_prediction();
    reset_unseen_faces();
    predict_forces(time_, dt / 2, nullptr, report);
  }
  move_solids(dt, report);  // S1
  const auto after = solids.empty() ? before : solids.snapshot();
  make_advection_velocity(report);  // F2
  {
    ScopedPhase phase(timers_, "F3 advection");
    const MovingSurface<dim> moving{before, after, [&solids](const SurfacePoint<dim>& point) {
                                      return solids.effective_velocity(point, point.position);
                                    }};
    fluid.advect(time_, dt, moving);
    {
      ScopedPhase geometry(timers_, "geometry");
      if (!solids.empty() || fluid.geometry_changes())
        system_.freeze(after);
    }
    fluid.revalidate(moving);
    reset_unseen_faces();
    report.ledger.open(total_momentum());
    report.transport_change = report.ledger.before() - last_momentum_;
  }
  {
    ScopedPhase phase(timers_, "F3 forces");
    locked_velocity_ = solids.locked_velocity(time_ + dt, time_ + dt);
    predict_forces(time_, dt, &report.ledger, report);
  }
  ScopedPhase phase(timers_, "S2");
  RCP<Vector> momentum = make_vector(solids.map());
  if (coupled())
    momentum = solid_momentum(time_, dt, &report.ledger, report);
  else
    unseen_buoyancy(dt, report);
  CoupledSolution solution = solve_settled(dt, momentum, report);
  check_possible(dt, report.incompatibility_s2);
  return solution;
}

template class Stepper<2>;
template class Stepper<3>;

}  // namespace lockstep
