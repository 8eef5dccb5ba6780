#pragma once
#include "interfaces/coupling.hpp"
#include "interfaces/prescribed_flux.hpp"
#include "interfaces/surface_forces.hpp"

namespace lockstep {

// Side interfaces of couplings: `Coupling` hands them out.

/// The impulses that go through the coupled volumes, for the ledger and for the forces that are
/// reported. Without it a run has no `momentum_error` with prescribed or soft solids, and the
/// forces on prescribed ones lack those of the pressure. `gas_pressure`: p̂ of the bubbles of a
/// GasCoupling; empty without any.
template <int dim>
class AuditedCoupling {
 public:
  virtual ~AuditedCoupling() = default;
  /// Impulse that each prescribed solid gave to the fluid of its share of the coupled volumes in a
  /// solve, face by face: mass times velocity change plus area times pressure jump. One per solid
  /// of the snapshot, zero for dynamic ones. Global. Collective.
  virtual std::vector<Momentum<dim>> prescribed_impulses(
      const std::vector<double>& velocity_before, const std::vector<double>& velocity_after,
      const Vector& scaled_pressure, const std::vector<double>& gas_pressure) const = 0;
  /// Impulses that the fluid gave to all solids in a solve through the coupled volumes: to each
  /// share of a volume the momentum of the fluid lumped on it before, less that after, and the
  /// pressures beside it, each at the nearest point of the surface. Their sums are those that row 2
  /// balances, and `prescribed_impulses`. `solution`: p̂ and V of all dofs. This rank's part.
  /// Throws InputError if they have no places. Collective.
  virtual std::vector<SurfaceImpulse<dim>> impulses_on_solids(
      const SolidSystem<dim>& solids, const std::vector<double>& velocity_before,
      const BlockVector& solution, const std::vector<double>& gas_pressure) const = 0;
  /// Returns what each prescribed solid of the system pushes into row 1, at the present time, face
  /// by face, so that a run can say whose motion closed fluid has no room for. Local.
  virtual std::vector<PrescribedFlux> solid_fluxes(const SolidSystem<dim>& solids) const = 0;
  /// Angular impulse about the origin that a solve makes because soft solids take the impulses of
  /// coupled volumes at their nodes, with diagonally lumped masses, and the fluid gives them at the
  /// volumes' centres: taken minus given [kg m^2/s]. Zero (to round-off) where W reproduces rigid
  /// motions and the lumping is consistent, as for rigid bodies. Named in the ledger. Global.
  /// Collective.
  virtual AngularVector<dim> lumping_torque_error(
      const SolidSystem<dim>&, const std::vector<double>& /*velocity_before*/,
      const std::vector<double>& /*velocity_after*/, const BlockVector& /*solution*/,
      const std::vector<double>& /*gas_pressure*/) const {
    return AngularVector<dim>::Zero();
  }
};

/// The hydrostatic force on closed solids, apart from what the control volumes make of it
/// (docs/method.md, "The hydrostatic force"). A coupling without it trusts the grid.
template <int dim>
class HydrostaticCoupling {
 public:
  virtual ~HydrostaticCoupling() = default;
  /// Adds dt (F_h + B^T p_h - W^T M_F g): the exact force of fluid at rest less that on the grid;
  /// external in the ledger. Returns it on prescribed solids, one per solid of the snapshot, for
  /// the forces that are reported. Collective.
  virtual std::vector<Momentum<dim>> add_hydrostatic_force(double dt, Vector& momentum) const = 0;
  /// Adds dt (W^T M_F g - B^T p_h): what a solve gives solids in fluid at rest. Local.
  virtual void add_impulse_at_rest(double dt, Vector& momentum) const = 0;
  /// The mass that solids have with the fluid on them, less M_S: the fluid lumped on them, and for
  /// rigid ones the added mass of a ball of the volume that they displace [kg]. An estimate, for
  /// contact. `lumped`: the coupling's added mass dM, or null. Null: none. Collective.
  virtual RCP<const CrsMatrix> mass_with_fluid(const SolidSystem<dim>& solids,
                                               const RCP<const CrsMatrix>& lumped) const = 0;
};

}  // namespace lockstep
