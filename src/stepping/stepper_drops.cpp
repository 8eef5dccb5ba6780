// Drops that hit solids.
#include <Tpetra_Vector.hpp>

#include "stepping/stepper.hpp"

namespace lockstep {

/// What they gave to dynamic solids since the last advection, to the momentum. Users see it, and
/// that on prescribed solids, among the forces of the fluid.
template <int dim>
void Stepper<dim>::add_drops(const StepContext<dim>& context, Vector& momentum,
                             StepReport<dim>& report) const {
  const LiquidFluid<dim>* liquid = components_.fluid->liquid();
  if (!liquid || !liquid->has_drops())
    return;
  const std::vector<SurfaceImpulse<dim>> impulses = liquid->impulses_on_solids();
  if (impulses.empty())
    return;
  const SolidSystem<dim>& solids = *components_.solids;
  const SurfaceSnapshot<dim>& surface = *system_.surface();
  const auto given = make_vector(solids.map());
  {
    const auto values = given->getDataNonConst();
    VelocityRow<dim> row;
    for (const SurfaceImpulse<dim>& hit : impulses) {
      report.hydrodynamic_impulse[surface.solid_of(hit.point.simplex)].add(hit.place, hit.impulse);
      solids.velocity_row(hit.point, hit.place, row);
      for (std::size_t k = 0; k < row.dofs.size(); ++k) {
        const int local = solids.map()->getLocalElement(row.dofs[k]);
        if (local >= 0)
          values[local] += row.coefficients[k].dot(hit.impulse);
      }
    }
  }
  momentum.update(1, *given, 1);
  if (context.ledger)
    context.ledger->add("drops", solids.momentum(*given));
}

template void Stepper<2>::add_drops(const StepContext<2>&, Vector&, StepReport<2>&) const;
template void Stepper<3>::add_drops(const StepContext<3>&, Vector&, StepReport<3>&) const;

}  // namespace lockstep
