#include "stepping/step/step_audit.hpp"
#include "coupling/solid_totals.hpp"

#include "base/errors.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>
#include <cmath>
#include <limits>

namespace lockstep {

template <int dim>
StepAudit<dim>::StepAudit(Components<dim>& components, CoupledSystem<dim>& system, bool with_energy,
                          bool with_surface_forces)
    : components_(components),
      sides_(components),
      system_(system),
      with_surface_forces_(with_surface_forces) {
  check_input(!with_surface_forces || sides_.audited_coupling,
              "An observer asks for the force on a part of a surface, but the coupling \"{}\" does "
              "not tell where it pushes; take another coupling, or leave the observer out.",
              components.coupling->name());
  if (with_energy)
    energy_.emplace(components, system);
}

/// Momentum of u* without what is lumped on solids.
template <int dim>
Momentum<dim> StepAudit<dim>::fluid_momentum() const {
  return sides_.audited_fluid ? sides_.audited_fluid->momentum() : Momentum<dim>();
}

/// Momentum of fluid (u*), lumped fluid and solids (M_S V).
template <int dim>
Momentum<dim> StepAudit<dim>::total_momentum(double time, const Momentum<dim>& of_fluid) const {
  const auto& solids = *components_.solids;
  Momentum<dim> total = of_fluid;
  total += system_.lumped_fluid_momentum(components_.fluid->coupled_velocity());
  if (solids.has_unknowns())
    total += solids.momentum(*solids.explicit_momentum(time, 0));
  return total;
}

template <int dim>
void StepAudit<dim>::begin(const StepTime& step) {
  const auto& fluid = *components_.fluid;
  cfl_ = step.dt * fluid.largest_speed() / fluid.smallest_length();
  if (energy_)
    energy_->begin();
}

template <int dim>
void StepAudit<dim>::end_transport(const StepTime& step) {
  before_ = total_momentum(step.begin, fluid_momentum());
  if (energy_)
    energy_->end_transport();
}

template <int dim>
void StepAudit<dim>::end_forces() {
  if (energy_)
    energy_->end_forces();
}

template <int dim>
void StepAudit<dim>::end_viscosity() {
  if (energy_)
    energy_->end_friction();
}

template <int dim>
StepReport<dim> StepAudit<dim>::report(const StepContext<dim>& context,
                                       const StageResults<dim>& stages) const {
  const CoupledSolution& solution = stages.end.solution;
  StepReport<dim> report;
  report.dt = context.step.dt;
  report.time = context.step.end();
  report.cfl = cfl_;
  report.s1 = stages.path.report;
  report.s1.add_work(stages.start.pressure_work);
  report.f2 = stages.advection.solve;
  report.s2 = solution.report;
  report.s2.add_work(stages.friction.pressure_work);
  report.incompatibility_s1 = stages.path.incompatibility;
  report.incompatibility_f2 = stages.advection.incompatibility;
  report.incompatibility_s2 = solution.incompatibility;
  report.viscous_iterations = stages.start.viscous.iterations + stages.friction.viscous.iterations;
  report.viscous_dissipation = stages.friction.viscous.dissipation;
  report.viscous_number = stages.friction.viscous_number;
  report.is_settled = stages.path.is_converged && solution.is_converged;
  report.stretch_beyond_limit = stages.path.stretch_beyond_limit;
  report.contact_position = stages.path.contact;
  report.contact_velocity = stages.end.contact;
  report.hydrodynamic_impulse = stages.solids.on_each;
  report.max_divergence = largest_divergence(system_.blocks(context.dt), solution);
  report.ledger.open(before_);
  report.transport_change = before_ - last_momentum_;
  book_forces(stages, report);
  book_pressure(stages, report);
  if (components_.solids->has_unknowns())
    book_solids(context, stages, report);
  if (with_surface_forces_)
    report.surface_forces = surface_forces(stages);
  return report;
}

/// Largest residual of row 1 per cell [1/s].
template <int dim>
double StepAudit<dim>::largest_divergence(const BlockSystem& blocks,
                                          const CoupledSolution& solution) const {
  Vector residual(*solution.rhs.pressure, Teuchos::Copy);
  apply(*blocks.pressure_block(), *solution.unknowns.pressure, residual, -1, 1);
  if (blocks.has_solid())
    blocks.coupling_transposed()->apply(*solution.unknowns.solid, residual, Teuchos::TRANS, 1, 1);
  return residual.normInf() / std::pow(components_.fluid->smallest_length(), dim);
}

/// Books the external impulses of explicit forces, viscosity and contact.
template <int dim>
void StepAudit<dim>::book_forces(const StageResults<dim>& stages, StepReport<dim>& report) const {
  MomentumLedger<dim>& ledger = report.ledger;
  ledger.add("body forces", stages.forces.body);
  ledger.add("surface tension", stages.forces.tension.value_or(Momentum<dim>()));
  ledger.add("viscous boundaries",
             stages.friction.viscous.boundary_impulse - stages.friction.tension);
  ledger.add("surface tension", stages.friction.tension);
  ledger.add("solid forces", stages.solids.forces);
  ledger.add("hydrostatic force", stages.solids.hydrostatic);
  ledger.add("joints", stages.solids.joints);
  ledger.add("drops", stages.solids.drops);
  ledger.add("contact", stages.end.contact.external_impulse);
}

/// Books the impulses of the pressure on walls and prescribed solids, from its own forces there.
template <int dim>
void StepAudit<dim>::book_pressure(const StageResults<dim>& stages, StepReport<dim>& report) const {
  const CoupledSolution& solution = stages.end.solution;
  const Vector& pressure = *solution.unknowns.pressure;
  const Momentum<dim> walls = sides_.audited_fluid
                                  ? sides_.audited_fluid->boundary_pressure_impulse(pressure)
                                  : Momentum<dim>();
  report.ledger.add("walls", walls);
  if (!solution.gas_momentum.is_null())  // gas pushes on what is around it; sides push back
    report.ledger.add("walls through gas",
                      sides_.gas_fluid->gas_side_impulse(solution.gas_pressure));
  report.boundary_impulse = walls + report.ledger.impulse_of("viscous boundaries");
  std::vector<Momentum<dim>> prescribed;
  if (sides_.audited_coupling)
    prescribed = sides_.audited_coupling->prescribed_impulses(
        solution.coupled_before, components_.coupling->velocity(*solution.velocity), pressure,
        solution.gas_pressure);
  report.ledger.add("prescribed solids", total_of(prescribed));
  for (std::size_t s = 0; s < prescribed.size(); ++s)
    report.hydrodynamic_impulse[s] -= prescribed[s];
  const auto& by_friction = stages.friction.viscous.prescribed_impulses;
  for (std::size_t s = 0; s < by_friction.size(); ++s)
    report.hydrodynamic_impulse[s] -= by_friction[s];
}

/// Books constraints and numerical torques, and reports what the fluid gave to every solid, on top
/// of what is there.
template <int dim>
void StepAudit<dim>::book_solids(const StepContext<dim>& context, const StageResults<dim>& stages,
                                 StepReport<dim>& report) const {
  const SolidSystem<dim>& solids = *components_.solids;
  const CoupledSolution& solution = stages.end.solution;
  const BlockVector whole{solution.unknowns.pressure, solution.velocity};
  Vector given(*solution.momentum, Teuchos::Copy);
  if (!solution.gas_momentum.is_null())
    given.update(1, *solution.gas_momentum, 1);
  const RCP<const Vector> reactions =
      system_.reactions(context.dt, context.constraints, given, whole);
  report.ledger.add("locks", solids.momentum(*reactions));
  report.reactions = reactions;
  if (sides_.audited_coupling)
    report.lumping_torque_error = sides_.audited_coupling->lumping_torque_error(
        solids, solution.coupled_before, components_.coupling->velocity(*whole.solid), whole,
        solution.gas_pressure);
  report.ledger.add("levers of soft solids", {Point<dim>::Zero(), report.lumping_torque_error});
  const RCP<const Vector> implicit = implicit_impulse(solids, context.dt, *whole.solid);
  report.linearisation_impulse =
      solids.momentum(*implicit).angular + inner_angular_impulse(solids, context.dt);
  report.ledger.add("linearised forces", {Point<dim>::Zero(), report.linearisation_impulse});
  const RCP<Vector> gained = make_vector(solids.map());
  apply(*solids.mass(), *whole.solid, *gained);
  gained->update(-1, *solution.momentum, -1, *reactions, 1);
  gained->update(-1, *implicit, 1);
  if (!stages.friction.viscous.solid_impulse.is_null())
    gained->update(1, *stages.friction.viscous.solid_impulse, 1);
  add_each(solids.momentum_of_each(*gained), report.hydrodynamic_impulse);
  if (!stages.end.contact_impulse.is_null())
    report.contact_impulse = contact_impulses(stages.end);
}

/// Impulses of contact on every solid, by themselves on those dofs and solids whose motion is
/// given.
template <int dim>
std::vector<Momentum<dim>> StepAudit<dim>::contact_impulses(
    const MotionWithContacts<dim>& motion) const {
  const SolidSystem<dim>& solids = *components_.solids;
  Vector total(*motion.contact_impulse, Teuchos::Copy);
  if (!motion.contact.impulse_on_given.is_null())
    total.update(1, *motion.contact.impulse_on_given, 1);
  std::vector<Momentum<dim>> on_each = solids.momentum_of_each(total);
  for (const PrescribedPush<dim>& push : motion.contact.on_prescribed)
    on_each[push.solid] += push.impulse;
  return on_each;
}

/// The impulses of the fluid on the surfaces, each at the point of the surface that is nearest.
template <int dim>
SurfaceForces<dim> StepAudit<dim>::surface_forces(const StageResults<dim>& stages) const {
  const SolidSystem<dim>& solids = *components_.solids;
  const SurfaceSnapshot<dim>& surface = *system_.surface();
  const CoupledSolution& solution = stages.end.solution;
  SurfaceForces<dim> forces;
  forces.of_whole = stages.solids.on_each;
  forces.at_places = sides_.audited_coupling->impulses_on_solids(
      solids, solution.coupled_before, {solution.unknowns.pressure, solution.velocity},
      solution.gas_pressure);
  for (SurfaceImpulse<dim> pull : stages.friction.viscous.on_surface) {
    const int solid = surface.solid_of(pull.point.simplex);
    if (surface.solids()[solid].rigid)
      pull.point = surface.closest_on_solid(surface.beside(solid, pull.place), solid);
    forces.at_places.push_back(pull);
  }
  for (const SurfaceImpulse<dim>& hit : stages.solids.hits) {
    const int solid = surface.solid_of(hit.point.simplex);
    Momentum<dim> of_drop;
    of_drop.add(solids.own_place(solid, hit.place), hit.impulse);
    forces.of_whole[solid] -= of_drop;
  }
  if (is_root(solids.comm()))
    forces.at_places.insert(forces.at_places.end(), stages.solids.hits.begin(),
                            stages.solids.hits.end());
  for (SurfaceImpulse<dim>& one : forces.at_places) {
    one.point = solids.repeated().empty() ? one.point : solids.repeated().own_point(one.point);
    one.place = solids.own_place(surface.solid_of(one.point.simplex), one.place);
  }
  return forces;
}

template <int dim>
void StepAudit<dim>::end_projection(const StepContext<dim>& context,
                                    const StageResults<dim>& stages,
                                    const StepReport<dim>& report) {
  if (energy_)
    energy_->end_solve(context, stages.end.solution, stages.friction.viscous.solid_impulse,
                       report.reactions);
}

template <int dim>
void StepAudit<dim>::close(const StepContext<dim>& context, const CoupledSolution& solution,
                           StepReport<dim>& report) {
  const auto& fluid = *components_.fluid;
  const auto& solids = *components_.solids;
  const std::vector<double> coupled_after = components_.coupling->velocity(*solution.velocity);
  const Momentum<dim> of_fluid = fluid_momentum();
  report.fluid_momentum = of_fluid + system_.lumped_fluid_momentum(coupled_after);
  report.fluid_kinetic_energy = system_.lumped_fluid_energy(coupled_after);
  if (sides_.audited_fluid)
    report.fluid_kinetic_energy += sides_.audited_fluid->kinetic_energy();
  report.fluid_volume = fluid.fluid_volume();
  if (const LiquidFluid<dim>* liquid = fluid.liquid()) {
    report.liquid = liquid->report();
    report.fluid_volume = report.liquid->volume;
  }
  if (solids.has_unknowns()) {
    const auto after = make_vector(solids.map());
    apply(*solids.mass(), *solution.velocity, *after);
    report.solid_momentum = solids.momentum(*after);
  }
  report.n_clamped_elements = n_clamped_elements(solids);
  report.ledger.close(report.fluid_momentum + report.solid_momentum);
  // Not that of the ledger: a restarted run finds it anew, and must not differ in its last digit.
  last_momentum_ = total_momentum(context.step.begin, of_fluid);
  find_errors(report);
  for (const auto& state : solids.states()) {
    report.solid_kinetic_energy += state.kinetic_energy;
    report.elastic_energy += state.elastic_energy;
  }
  if (energy_)
    report.energy = energy_->end(report.time, report.dt);
}

/// The errors of momentum that the closed ledger shows; nan if not all plug-ins tell theirs.
/// Torques of periodic fluids have no common origin.
template <int dim>
void StepAudit<dim>::find_errors(StepReport<dim>& report) const {
  if (!sides_.audited) {
    report.momentum_error = report.angular_momentum_error =
        std::numeric_limits<double>::quiet_NaN();
    return;
  }
  // sum m |u| >= sum m u^2 / max |u|
  const double fastest = components_.fluid->largest_speed();
  const double momentum_scale = fastest > 0 ? 2 * report.fluid_kinetic_energy / fastest : 0;
  report.momentum_error = report.ledger.linear_error(momentum_scale);
  const double extent = components_.fluid->bounds().sizes().maxCoeff();
  const double length = std::isfinite(extent) ? extent : std::pow(report.fluid_volume, 1.0 / dim);
  if (!components_.fluid->is_periodic())
    report.angular_momentum_error = report.ledger.angular_error(length, momentum_scale);
}

template class StepAudit<2>;
template class StepAudit<3>;

}  // namespace lockstep
