#pragma once
#include "interfaces/fluid.hpp"
#include "interfaces/solid.hpp"
#include "interfaces/strategy.hpp"

namespace lockstep {

template <int dim>
class SolidSystem;
template <int dim>
class AuditedCoupling;
template <int dim>
class GasCoupling;
template <int dim>
class HydrostaticCoupling;
template <int dim>
class ViscousCoupling;

/// Exchanges momentum between fluid and solids: from the fluid's coupled control volumes and the
/// solids' velocity rows it makes B^T, the added mass and momentum, and hands velocities back. Its
/// `open_fraction` decides which control volumes it takes. Geometry is frozen between two
/// `assemble`. Its sides, null where it does without, are in interfaces/coupling_sides.hpp, gas.hpp
/// and viscosity.hpp; they are the same in all of a run and on all ranks.
template <int dim>
class Coupling : public PlugIn, public OpenFractionRule<dim> {
 public:
  /// Computes everything that depends on where the solids are, and on how prescribed ones move
  /// there (W_k V_k of the present time, used below); `surface` must outlive the next call.
  /// Collective.
  virtual void assemble(const FluidDiscretization<dim>& fluid, const SolidSystem<dim>& solids,
                        const SurfaceSnapshot<dim>& surface) = 0;

  // Blocks. Null when there are no dynamic solids.
  virtual RCP<const CrsMatrix> coupling_transposed() const = 0;  ///< B^T [m^(dim-1)]
  virtual RCP<const CrsMatrix> added_mass() const = 0;  ///< dM: M̃_S = M_S + dM [kg], or null: none

  /// rhs += V G_c^T W_k V_k: what prescribed solids push into row 1 [m^dim/s]. Collective.
  virtual void add_prescribed_divergence(Vector& rhs) const = 0;
  /// rhs += W_d^T M_F (u - W_k V_k): fluid momentum lumped on the solids, row 2 [kg m/s] (with
  /// diagonal lumping each solid carries its own share and W_k V_k stays out). Collective.
  virtual void add_lumped_momentum(const std::vector<double>& coupled_velocity,
                                   Vector& rhs) const = 0;
  /// W_d V_S + W_k V_k for each coupled volume [m/s]. Collective.
  virtual std::vector<double> velocity(const Vector& solid_velocity) const = 0;
  /// W_d V_S + W_k V_k with the effective velocity of every solid over the last `move` (F2) instead
  /// of unknowns [m/s], one entry per coupled volume. Collective.
  virtual std::vector<double> effective_velocity(const SolidSystem<dim>& solids) const = 0;
  /// rhs += what the solids push with these velocities, of the last `move` [m^dim/s]. Collective.
  virtual void add_effective_divergence(const SolidSystem<dim>& solids, Vector& rhs) const = 0;

  /// M_F per coupled volume, after volume subtraction and balancing [kg]. Local.
  virtual const std::vector<double>& fluid_mass() const = 0;

  virtual const AuditedCoupling<dim>* audit() const { return nullptr; }
  virtual const GasCoupling<dim>* gas() const { return nullptr; }  ///< null: a fluid traps none
  /// Null: the grid is trusted with the volume of every body.
  virtual const HydrostaticCoupling<dim>* hydrostatics() const { return nullptr; }
  virtual const ViscousCoupling<dim>* viscosity() const { return nullptr; }  ///< null: inviscid
};

}  // namespace lockstep
