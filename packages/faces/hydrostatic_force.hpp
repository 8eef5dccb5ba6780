#pragma once
#include <vector>

#include "faces/hydrostatic_load.hpp"
#include "interfaces/coupling_sides.hpp"

namespace lockstep {

/// The hydrostatic force of a coupling by faces: what `HydrostaticLoads` has found, on the dofs of
/// the solids.
template <int dim>
class HydrostaticForce : public HydrostaticCoupling<dim> {
 public:
  /// Starts anew without loads; the caller keeps the surface alive.
  void reset(const SurfaceSnapshot<dim>& surface);
  /// Takes loads that have been summed; the caller keeps the solids alive.
  void take(const HydrostaticLoads<dim>& loads, const SolidSystem<dim>& solids);

  std::vector<Momentum<dim>> add_hydrostatic_force(double dt, Vector& momentum) const override;
  void add_impulse_at_rest(double dt, Vector& momentum) const override;
  RCP<const CrsMatrix> mass_with_fluid(const SolidSystem<dim>& solids,
                                       const RCP<const CrsMatrix>& lumped) const override;

 private:
  const SurfaceSnapshot<dim>* surface_ = nullptr;
  const SolidSystem<dim>* solids_ = nullptr;  ///< null: no loads
  std::vector<AxisLoad<dim>> at_rest_, corrections_;
  std::vector<DisplacedMass<dim>> displaced_masses_;
};

}  // namespace lockstep
