#include "stepping/step/solid_forces.hpp"

#include <Tpetra_Vector.hpp>

#include "coupling/nonlinear_bodies.hpp"
#include "coupling/solid_totals.hpp"
#include "interfaces/liquid.hpp"

namespace lockstep {

namespace {
/// The part of each solid's motion that a step resolves, for solids with implicit inner forces: 1
/// where the step is short for them, V.K V dt^2 small beside V.M V, and 0 where it is long. In the
/// solid's own frame: neither a translation nor the rotation about which forces are linearised is a
/// motion that forces would have to resolve.
template <int dim>
std::vector<double> resolved_parts(const SolidSystem<dim>& solids,
                                   const NonlinearBodies<dim>& bodies,
                                   const RCP<const CrsMatrix>& added_mass, double dt) {
  Vector strained(*solids.velocity(), Teuchos::Copy);
  if (const RCP<const Vector> turning = linearisation(solids); !turning.is_null())
    strained.update(-1, *turning, 1);
  const RCP<const Vector> velocity = bodies.without_translations(strained);
  const std::vector<double> given = bodies.dot(*velocity, *implicit_impulse(solids, dt, *velocity));
  Vector product(solids.map());
  apply(*solids.full_block(added_mass, dt), *velocity, product);
  const std::vector<double> whole = bodies.dot(*velocity, product);
  std::vector<double> parts;
  for (std::size_t s = 0; s < whole.size(); ++s) {
    const double stiff = -given[s];
    if (!(stiff > 0) || !(whole[s] > stiff)) {
      parts.push_back(stiff > 0 ? 0 : 1);
      continue;
    }
    const double ratio = 2 * stiff / (whole[s] - stiff);
    parts.push_back(1 / ((1 + ratio) * (1 + ratio)));
  }
  return parts;
}
}  // namespace

template <int dim>
RCP<Vector> SolidForces<dim>::midpoint_correction(double dt) const {
  const auto& solids = *components_.solids;
  const RCP<Vector> correction = make_vector(solids.map());
  solids.add_midpoint_correction(dt, *correction);
  if (has_implicit_forces(solids)) {
    const NonlinearBodies<dim> bodies(solids);
    bodies.scale(resolved_parts(solids, bodies, components_.coupling->added_mass(), dt),
                 *correction);
  }
  return correction;
}

template <int dim>
RCP<Vector> SolidForces<dim>::own_momentum(const StepContext<dim>& context) const {
  const RCP<Vector> momentum = components_.solids->explicit_momentum(context.begin, context.dt);
  if (!context.joints.given.is_null())
    momentum->update(1, *context.joints.given, 1);
  return momentum;
}

template <int dim>
SolidMomentum<dim> SolidForces<dim>::momentum(const StepContext<dim>& context,
                                              const RCP<const Vector>& correction) const {
  const auto& solids = *components_.solids;
  const bool has_unknowns = solids.has_unknowns();
  SolidMomentum<dim> result;
  result.momentum = has_unknowns ? own_momentum(context) : make_vector(solids.map());
  if (has_unknowns && context.moves_positions)
    result.momentum->update(
        1, correction.is_null() ? *midpoint_correction(context.dt) : *correction, 1);
  add_hydrostatic_correction(context, result);
  if (context.moves_positions)
    return result;
  if (has_unknowns) {
    result.forces = external_impulse(solids, context.begin, context.dt);
    if (!context.joints.given.is_null())
      result.joints = solids.momentum(*context.joints.given);
  }
  if (context.takes_drops)
    add_drops(result);
  return result;
}

template <int dim>
void SolidForces<dim>::add_hydrostatic_correction(const StepContext<dim>& context,
                                                  SolidMomentum<dim>& result) const {
  const auto& solids = *components_.solids;
  const auto correction = make_vector(solids.map());
  result.on_each.assign(solids.solids().size(), {});
  if (sides_.hydrostatic_coupling)
    result.on_each = sides_.hydrostatic_coupling->add_hydrostatic_force(context.dt, *correction);
  const std::vector<Momentum<dim>> of_each = solids.momentum_of_each(*correction);
  add_each(of_each, result.on_each);
  if (!solids.has_unknowns())
    return;
  result.momentum->update(1, *correction, 1);
  if (!context.moves_positions)
    result.hydrostatic = total_of(of_each);
}

template <int dim>
void SolidForces<dim>::add_drops(SolidMomentum<dim>& result) const {
  const LiquidFluid<dim>* liquid = components_.fluid->liquid();
  if (!liquid || !liquid->has_drops())
    return;
  result.hits = liquid->impulses_on_solids();
  if (result.hits.empty())
    return;
  const SolidSystem<dim>& solids = *components_.solids;
  const SurfaceSnapshot<dim>& surface = *system_.surface();
  const auto given = make_vector(solids.map());
  {
    const auto values = given->getDataNonConst();
    VelocityRow<dim> row;
    for (const SurfaceImpulse<dim>& hit : result.hits) {
      const int solid = surface.solid_of(hit.point.simplex);
      result.on_each[solid].add(solids.own_place(solid, hit.place), hit.impulse);
      solids.velocity_row(hit.point, hit.place, row);
      for (std::size_t k = 0; k < row.dofs.size(); ++k) {
        const int local = solids.map()->getLocalElement(row.dofs[k]);
        if (local >= 0)
          values[local] += row.coefficients[k].dot(hit.impulse);
      }
    }
  }
  result.momentum->update(1, *given, 1);
  result.drops = solids.momentum(*given);
}

template class SolidForces<2>;
template class SolidForces<3>;

}  // namespace lockstep
