#pragma once
#include "interfaces/coupling.hpp"

namespace lockstep {

// Side interfaces of couplings (`side_of`).

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

/// Correction of the hydrostatic force where the control volumes do not resolve a solid's displaced
/// volume. A coupling without it needs none.
template <int dim>
class UnseenBuoyancy {
 public:
  virtual ~UnseenBuoyancy() = default;
  /// Adds the buoyant impulse over dt on solids whose displaced volume the grid does not see right,
  /// for a given acceleration g of the fluid [m/s^2]; external in the ledger. Returns that on
  /// prescribed solids, one per solid of the snapshot, for the forces that are reported.
  /// Collective.
  virtual std::vector<Momentum<dim>> add_unseen_buoyancy(const Point<dim>& gravity, double dt,
                                                         Vector& rhs) const = 0;
};

}  // namespace lockstep
