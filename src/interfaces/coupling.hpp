#pragma once
#include "interfaces/fluid.hpp"
#include "interfaces/solid.hpp"
#include "interfaces/strategy.hpp"

namespace lockstep {

template <int dim>
class SolidSystem;

/// How fluid and solids exchange momentum: from the fluid's coupled control volumes and the solids'
/// velocity rows it makes B^T, the added mass and momentum, and hands velocities back. Its
/// `open_fraction` decides which control volumes it takes. Geometry is frozen between two
/// `assemble`.
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
  virtual RCP<const CrsMatrix> added_mass() const = 0;           ///< dM: M̃_S = M_S + dM [kg]

  /// rhs += V G_c^T W_k V_k: what prescribed solids push into row 1 [m^dim/s]. Collective.
  virtual void add_prescribed_divergence(Vector& rhs) const = 0;
  /// The same of each prescribed solid alone, at the present time, face by face: one for every
  /// prescribed solid of the system. Local.
  virtual std::vector<PrescribedFlux> solid_fluxes(const SolidSystem<dim>&) const { return {}; }
  /// rhs += W_d^T M_F (u - W_k V_k): fluid momentum lumped on the solids, row 2 [kg m/s] (with
  /// diagonal lumping each solid carries its own share and W_k V_k stays out). Collective.
  virtual void add_lumped_momentum(const std::vector<double>& coupled_velocity,
                                   Vector& rhs) const = 0;
  /// W_d V_S + W_k V_k for each coupled volume [m/s]. Collective.
  virtual std::vector<double> velocity(const Vector& solid_velocity) const = 0;
  /// The same with every solid's effective velocity (F2); no unknowns. Collective.
  virtual std::vector<double> effective_velocity(const SolidSystem<dim>& solids) const = 0;
  /// V G_c^T u_c: minus the outflow through coupled volumes of given velocity [m^dim/s].
  /// Collective.
  virtual void add_divergence(const std::vector<double>& coupled_velocity, Vector& rhs) const = 0;

  /// M_F per coupled volume, after volume subtraction and balancing [kg]. Local.
  virtual const std::vector<double>& fluid_mass() const = 0;
  /// Adds the buoyant impulse over dt on solids whose displaced volume the grid does not see right,
  /// for a given acceleration g of the fluid [m/s^2]; external in the ledger. Returns that on
  /// prescribed solids, one per solid of the snapshot, for the forces that are reported.
  /// Collective.
  virtual std::vector<Momentum<dim>> add_unseen_buoyancy(const Point<dim>& gravity, double dt,
                                                         Vector& rhs) const = 0;

  /// Impulse that each prescribed solid gave to the fluid of its share of the coupled volumes in a
  /// solve, face by face: mass times velocity change plus area times pressure jump. One per solid
  /// of the snapshot, zero for dynamic ones. Global. Collective.
  virtual std::vector<Momentum<dim>> prescribed_impulses(const std::vector<double>& velocity_before,
                                                         const std::vector<double>& velocity_after,
                                                         const Vector& scaled_pressure) const = 0;

  /// Angular impulse about the origin that a solve makes because soft solids take the impulses of
  /// coupled volumes at their nodes, with diagonally lumped masses, and the fluid gives them at the
  /// volumes' centres: taken minus given [kg m^2/s]. Zero (to round-off) where W reproduces rigid
  /// motions and the lumping is consistent, as for rigid bodies. Named in the ledger. Global.
  /// Collective.
  virtual AngularVector<dim> lever_impulse(const SolidSystem<dim>&,
                                           const std::vector<double>& /*velocity_before*/,
                                           const std::vector<double>& /*velocity_after*/,
                                           const BlockVector& /*solution*/) const {
    return AngularVector<dim>::Zero();
  }

  /// Row of the dynamic solids (ids of SolidSystem's map) and the prescribed velocity at a viscous
  /// link.
  struct LinkRow {
    std::vector<GlobalIndex> dofs;
    std::vector<double> weights;
    double prescribed = 0;                     ///< velocity that prescribed solids contribute [m/s]
    double prescribed_share = 0;               ///< their part of the link, 0..1
    int prescribed_solid = -1;                 ///< one of them: the last with a share
    Point<dim> position = Point<dim>::Zero();  ///< where the link pulls on the solid [m]
    int solid = -1;                            ///< the one with the largest share
  };
  /// `assemble` and the surface it was given must still be valid. Local.
  virtual void link_row(const ViscousLink<dim>& link, const SolidSystem<dim>& solids,
                        LinkRow& row) const = 0;
};

}  // namespace lockstep
