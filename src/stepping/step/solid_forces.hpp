#pragma once

#include "coupling/coupled_system.hpp"
#include "interfaces/surface_forces.hpp"
#include "stepping/step/components.hpp"
#include "stepping/step/step_context.hpp"

namespace lockstep {

/// The explicit momentum of the solids before a coupled solve. Impulses that the momentum ledger
/// books are zero where positions are moved.
template <int dim>
struct SolidMomentum {
  RCP<Vector> momentum;       ///< M_S V_S* without contact and viscous drag
  Momentum<dim> forces;       ///< given by weight, loads and control
  Momentum<dim> hydrostatic;  ///< exact hydrostatic force less that on the grid
  Momentum<dim> joints;       ///< at the begin of the step
  Momentum<dim> drops;        ///< impulse of drops that hit dynamic solids
  /// Impulses of that difference and of drops on every solid, prescribed ones included.
  std::vector<Momentum<dim>> on_each;
  std::vector<SurfaceImpulse<dim>> hits;  ///< by these drops; the same on all ranks
};

/// Explicit forces on the solids: their own, those of joints at the begin of the step, the
/// hydrostatic force (see HydrostaticCoupling), drops that hit them.
template <int dim>
class SolidForces {
 public:
  SolidForces(const Components<dim>& components, const CoupledSystem<dim>& system)
      : components_(components), system_(system), sides_(components) {}

  /// The momentum for a coupled solve. `correction`: of positions at the midpoint, in the place of
  /// `midpoint_correction`; null: that. Collective.
  SolidMomentum<dim> momentum(const StepContext<dim>& context,
                              const RCP<const Vector>& correction = {}) const;
  /// Own forces, and what joints gave where the step began. Collective.
  RCP<Vector> own_momentum(const StepContext<dim>& context) const;
  /// The second-order models' correction over the half step dt, of each solid with implicit forces
  /// the part of it that the step resolves. Collective.
  RCP<Vector> midpoint_correction(double dt) const;

 private:
  void add_hydrostatic_correction(const StepContext<dim>& context,
                                  SolidMomentum<dim>& result) const;
  void add_drops(SolidMomentum<dim>& result) const;

  const Components<dim>& components_;
  const CoupledSystem<dim>& system_;
  ComponentSides<dim> sides_;
};

}  // namespace lockstep
