#pragma once
#include <optional>
#include <vector>

#include "coupling/momentum_ledger.hpp"
#include "interfaces/contact.hpp"
#include "interfaces/energy.hpp"
#include "interfaces/liquid.hpp"
#include "interfaces/strategy.hpp"
#include "interfaces/surface_forces.hpp"

namespace lockstep {

/// Report of one step.
template <int dim>
struct StepReport {
  double time = 0, dt = 0;  ///< time at the end [s]
  double cfl = 0;           ///< CFL number of u^n over dt [1]
  SolveReport s1, f2, s2;
  int viscous_iterations = 0;
  double viscous_dissipation = 0;  ///< see ViscousResult [W]
  double viscous_number = 0;       ///< nu dt / h^2 of the step; 0 without viscosity
  double max_divergence = 0;       ///< after F4, per cell [1/s]
  double incompatibility_s1 = 0, incompatibility_f2 = 0,
         incompatibility_s2 = 0;  ///< removed, relative
  MomentumLedger<dim> ledger;
  double momentum_error = 0, angular_momentum_error = 0;
  Momentum<dim> fluid_momentum, solid_momentum, boundary_impulse;
  /// Change of the momentum by advection, uncovered, occlusion resets and the change of lumped
  /// masses.
  Momentum<dim> transport_change;
  /// Numerical torques over dt, see AuditedCoupling::lumping_torque_error and
  /// implicit_impulse.
  AngularVector<dim> lumping_torque_error = AngularVector<dim>::Zero();
  AngularVector<dim> linearisation_impulse = AngularVector<dim>::Zero();
  double fluid_kinetic_energy = 0, solid_kinetic_energy = 0, elastic_energy = 0;  ///< [J]
  std::optional<EnergyBudget> energy;  ///< if it was asked for
  double fluid_volume = 0;
  std::optional<LiquidReport> liquid;  ///< if it has a free surface
  bool is_settled = true;  ///< implicit forces of solids are those of where they move to
  GlobalIndex n_clamped_elements = 0;               ///< see SolidOutput
  double stretch_beyond_limit = 0;                  ///< see SolidOutput [1]
  std::vector<Momentum<dim>> hydrodynamic_impulse;  ///< per solid over dt, angular about the origin
  /// By contacts and limits of joints on dynamic solids, per solid over dt, angular about the
  /// origin; empty: there are none.
  std::vector<Momentum<dim>> contact_impulse;
  std::optional<SurfaceForces<dim>> surface_forces;  ///< if they were asked for
  ContactReport<dim> contact_position, contact_velocity;
  RCP<const Vector> reactions;  ///< impulses of constraints in S2, generalized; null: no unknowns
};

}  // namespace lockstep
