#include "stepping/step/step_energy.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>

#include "linear/vector_sums.hpp"

namespace lockstep {

namespace {

/// Work of one model's forces [J]; all are loads if it tells no other.
template <int dim>
SolidWork work_of_model(const SolidModel<dim>& model, const StepContext<dim>& context,
                        const Vector& velocity, const Vector& mean) {
  if (const auto* audited = model.audit()) {
    if (const auto work = audited->solid_work(context.begin, context.dt, velocity, mean))
      return *work;
  }
  Vector impulse(mean.getMap()), without(mean.getMap());
  model.explicit_momentum(context.begin, context.dt, impulse);
  model.explicit_momentum(context.begin, 0, without);
  impulse.update(-1, without, 1);
  SolidWork work;
  work.loads = dot(impulse, mean);
  return work;
}

template <int dim>
SolidWork work_of_models(const SolidSystem<dim>& solids, const StepContext<dim>& context,
                         const Vector& velocity, const Vector& mean) {
  SolidWork total;
  const std::vector<Block> blocks = solids.blocks();
  for (int m = 0; m < solids.n_models(); ++m) {
    const auto part = [&](const Vector& stacked) {
      return stacked.offsetView(solids.model(m).dof_map(), blocks[m].begin)->getVector(0);
    };
    const SolidWork work =
        work_of_model<dim>(solids.model(m), context, *part(velocity), *part(mean));
    total.elastic += work.elastic;
    total.damping += work.damping;
    total.control += work.control;
    total.loads += work.loads;
  }
  return total;
}

}  // namespace

template <int dim>
StepEnergy<dim>::StepEnergy(Components<dim>& components, const CoupledSystem<dim>& system)
    : components_(components),
      system_(system),
      fluid_(components.fluid->energy()),
      audited_(components.fluid->audit()) {}

/// Kinetic energy of u* [J], that of fluid lumped on solids included.
template <int dim>
double StepEnergy<dim>::fluid_energy() const {
  return (audited_ ? audited_->kinetic_energy() : 0) +
         system_.lumped_fluid_energy(components_.fluid->coupled_velocity());
}

template <int dim>
double StepEnergy<dim>::solid_energy(bool elastic) const {
  double sum = 0;
  for (const SolidState<dim>& state : components_.solids->states())
    sum += elastic ? state.elastic_energy : state.kinetic_energy;
  return sum;
}

template <int dim>
void StepEnergy<dim>::begin() {
  book_ = {};
  fluid_energy_ = fluid_energy();
  elastic_energy_ = solid_energy(true);
  kinetic_energy_ = fluid_energy_ + solid_energy(false);
  velocity_ = components_.solids->velocity();
}

template <int dim>
void StepEnergy<dim>::end_transport() {
  book_.transport = fluid_energy_ - fluid_energy();
  coupled_before_ = components_.fluid->coupled_velocity();
  if (fluid_)
    fluid_->begin_works();
}

template <int dim>
void StepEnergy<dim>::end_forces() {
  if (fluid_)
    fluid_->end_work();
}

template <int dim>
void StepEnergy<dim>::end_friction() {
  if (fluid_)
    fluid_->end_work();
}

template <int dim>
void StepEnergy<dim>::end_solve(const StepContext<dim>& context, const CoupledSolution& solution,
                                const RCP<const Vector>& friction,
                                const RCP<const Vector>& reactions) {
  if (fluid_) {
    fluid_->end_work();
    const std::vector<double> works = fluid_->works();
    book_.loads += works[0];
    book_.fluid_friction -= works[1];
    book_.pressure -= works[2];
  }
  if (components_.solids->has_unknowns())
    add_solids(context, solution, friction, reactions);
  add_lumping(solution);
}

template <int dim>
void StepEnergy<dim>::add_solids(const StepContext<dim>& context, const CoupledSolution& solution,
                                 const RCP<const Vector>& friction,
                                 const RCP<const Vector>& reactions) {
  const SolidSystem<dim>& solids = *components_.solids;
  Vector mean(*solution.velocity, Teuchos::Copy);
  mean.update(0.5, *velocity_, 0.5);
  const auto work_of = [&mean](const RCP<const Vector>& impulse) {
    return impulse.is_null() ? 0 : dot(*impulse, mean);
  };
  const SolidWork own = work_of_models<dim>(solids, context, *solution.velocity, mean);
  // The hydrostatic force, contact and drops have come to the momentum besides.
  Vector others(*solution.momentum, Teuchos::Copy);
  others.update(-1, *solids.explicit_momentum(context.begin, context.dt), 1);
  const double by_friction = work_of(friction), at_start = work_of(context.joints.given);
  book_.loads += own.loads + dot(others, mean) - by_friction - at_start;
  book_.fluid_friction -= by_friction;
  book_.solid_friction -= own.damping;
  book_.elasticity -= own.elastic;
  book_.ties -= own.control + at_start + work_of(reactions);
  Vector push(solids.map());
  components_.coupling->coupling_transposed()->apply(*solution.unknowns.pressure, push);
  book_.pressure += dot(push, mean);
}

/// Fluid that is lumped goes from u*_F to the velocity of the solid, which holds against it with
/// the mean of its own.
template <int dim>
void StepEnergy<dim>::add_lumping(const CoupledSolution& solution) {
  const Coupling<dim>& coupling = *components_.coupling;
  const std::vector<double>& mass = coupling.fluid_mass();
  const std::vector<double>& pushed = solution.coupled_before;
  const std::vector<double> before = coupling.velocity(*velocity_),
                            after = coupling.velocity(*solution.velocity);
  double lumping = 0, loads = 0;
  for (std::size_t f = 0; f < mass.size(); ++f) {
    lumping += 0.5 * mass[f] * (pushed[f] - before[f]) * (pushed[f] - after[f]);
    loads += 0.5 * mass[f] * (pushed[f] * pushed[f] - coupled_before_[f] * coupled_before_[f]);
  }
  sum_over_ranks(components_.solids->comm(), lumping, loads);
  book_.lumping += lumping;
  book_.loads += loads;
}

template <int dim>
EnergyBudget StepEnergy<dim>::end(double time, double dt) {
  const SolidSystem<dim>& solids = *components_.solids;
  if (solids.joints()) {
    for (const JointState& joint : solids.joints()->states(time))
      book_.joints += joint.power * dt;
  }
  book_.ties += book_.joints;
  book_.elastic_change = solid_energy(true) - elastic_energy_;
  book_.elasticity -= book_.elastic_change;
  book_.kinetic_change = fluid_energy() + solid_energy(false) - kinetic_energy_;
  return book_;
}

template class StepEnergy<2>;
template class StepEnergy<3>;

}  // namespace lockstep
