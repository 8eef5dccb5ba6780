#pragma once
#include <functional>
#include <vector>

#include "geometry/surface_snapshot.hpp"
#include "interfaces/momentum.hpp"
#include "interfaces/plug_in.hpp"
#include "linear/near_null_space.hpp"

namespace lockstep {

/// dim rows over generalized velocities: v(x) = sum_k coefficient_k V_{dof_k}.
template <int dim>
struct VelocityRow {
  std::vector<GlobalIndex> dofs;         ///< ids in `SolidModel::dof_map`
  std::vector<Point<dim>> coefficients;  ///< one column (a vector of space) per dof
  void clear() {
    dofs.clear();
    coefficients.clear();
  }
};

/// One solid's state for bodies.csv and the ledger.
template <int dim>
struct SolidState {
  std::string name;
  Point<dim> center_of_mass = Point<dim>::Zero();  ///< [m]
  Point<dim> velocity = Point<dim>::Zero();        ///< of the centre of mass [m/s]
  AngularVector<dim> angular_velocity = AngularVector<dim>::Zero();  ///< [rad/s]
  double mass = 0;                                                   ///< [kg]; 0 if prescribed
  double volume = 0;                                                 ///< [m^dim]; 0 for shells
  double kinetic_energy = 0, elastic_energy = 0;                     ///< [J]
};

/// A node of one model that a rigid solid of another carries: it moves as that solid's point.
template <int dim>
struct NodeAttachment {
  std::array<GlobalIndex, dim> dofs{};       ///< its velocity along each axis, ids in `dof_map`
  Point<dim> position = Point<dim>::Zero();  ///< present [m]
  std::string solid;                         ///< name of the rigid solid
};
struct SurfaceFrame;  // output/frames.hpp

/// An energy with the round-off that its computation carries [J].
struct ComputedEnergy {
  double value = 0, round_off = 0;
};

/// All solids of one kind (all rigid bodies, all deformables, ...): their unknowns, mass, forces
/// and surfaces. Knows nothing of the fluid and nothing of other models.
///
/// Generalized velocities V_S live on `dof_map` (one-to-one; ranks may be empty, SolidSystem pads).
/// Prescribed (kinematic, static) solids have surfaces but no dofs.
template <int dim>
class SolidModel : public PlugIn {
 public:
  // Surface. Local, replicated on all ranks.
  virtual const std::vector<SolidDescription>& solids()
      const = 0;                                        ///< ranges count from 0 in this model
  virtual const SurfaceMesh<dim>& surface() const = 0;  ///< at the present positions

  /// The rows that move a point of the surface (Section 8): for a rigid body those of the given x,
  /// so that rigid motions of a voxel surface are discretely divergence-free; for a deformable body
  /// the barycentric weights of the simplex' vertices. Empty for prescribed solids. Replaces `row`.
  /// Local.
  virtual void velocity_row(const SurfacePoint<dim>& point, const Point<dim>& x,
                            VelocityRow<dim>& row) const = 0;
  /// Velocity [m/s] of a prescribed solid's surface at the present time; zero for dynamic ones.
  /// Local.
  virtual Point<dim> prescribed_velocity(const SurfacePoint<dim>& point,
                                         const Point<dim>& x) const = 0;
  /// Displacement of the last `move` over its dt [m/s] at x^n (F2): for a rigid motion the twist
  /// log(relative pose)/dt at x; for nodes (x^{n+1} - x^n)/dt. Prescribed solids included. Local.
  virtual Point<dim> effective_velocity(const SurfacePoint<dim>& point,
                                        const Point<dim>& x) const = 0;

  // Operators with the geometry frozen.
  virtual RCP<const Map> dof_map() const = 0;
  /// M_S, SPD.
  virtual RCP<const LinearOperator> mass() const = 0;
  /// D(dt): symmetric negative semidefinite linearisation of the implicit forces [kg/s], or null.
  virtual RCP<const LinearOperator> implicit_force(double dt) const;
  /// The motions at the present positions that D does not resist, on `dof_map`, of models with
  /// nodes, without `mass`: solvers want them. Default: none. Collective.
  virtual NearNullSpace near_null_space() const { return {}; }
  /// momentum = M_S V_S* = M_S V^n + dt (explicit forces, gravity included) [kg m/s]. Collective.
  virtual void explicit_momentum(double time, double dt, Vector& momentum) const = 0;
  /// S1 only, dt the half step: added to `explicit_momentum` so that its V_S* is the velocity at
  /// the midpoint of the free motion, where the inertia is that of the turned body; then the
  /// positions are second order in time. Never part of S2: momentum stays exact. Default: nothing.
  /// Collective.
  virtual void add_midpoint_correction(double, Vector&) const {}
  /// Total of the external impulses (gravity, loads) inside explicit_momentum, for the ledger.
  /// Global.
  virtual Momentum<dim> external_impulse(double time, double dt) const = 0;
  /// A step from `time` to time + dt begins: from here on `locked_dofs` are its own. Collective.
  virtual void begin_step(double, double) {}
  /// Dofs held at a given velocity in the present step (ids in dof_map, those of this rank). Local.
  virtual std::vector<GlobalIndex> locked_dofs() const { return {}; }
  /// Mean velocity of each of them between two times, at equal times that of the instant. Default:
  /// zero. Local.
  virtual std::vector<double> locked_velocities(double, double) const {
    return std::vector<double>(locked_dofs().size(), 0);
  }
  /// This rank's nodes that solids of other models carry. The SolidSystem takes them out of the
  /// unknowns, and hands their velocities back with all others. Default: none. Local.
  virtual std::vector<NodeAttachment<dim>> attachments() const { return {}; }
  /// Linear and angular momentum (about the origin) of each solid for a generalized momentum q on
  /// dof_map; zero for prescribed ones. Every rank gets all. Collective.
  virtual std::vector<Momentum<dim>> momentum_of_each(const Vector& generalized_momentum) const = 0;

  // State.
  virtual RCP<const Vector> velocity() const = 0;         ///< V_S
  virtual void set_velocity(const Vector& velocity) = 0;  ///< V_S := velocity (end of S2, contact)
  /// A Newton iteration: linearises forces and D at the positions that this velocity reaches in dt,
  /// instead of at the present ones, until `move` or `set_velocity`. False if nothing depends on
  /// that. Default: nothing does. Collective.
  virtual bool linearise(double, const Vector&) { return false; }
  /// True if some forces are those at the positions that the solve leads to, and not linear in
  /// them: then `linearise`, `linearisation` and `unlinear_energy` are asked for. Local, the same
  /// on all ranks.
  virtual bool has_implicit_forces() const { return false; }
  /// The velocity about which forces and D are linearised at present; null: zero. Local.
  virtual RCP<const Vector> linearisation() const { return Teuchos::null; }
  /// The potential of these forces at the velocity V of the solve over dt, less the quadratic one
  /// of which `explicit_momentum` and D are made, up to a constant. Global, collective.
  virtual ComputedEnergy unlinear_energy(double, const Vector&) const { return {}; }
  /// S1: velocities that are about to move the positions by dt, changed by internal impulses
  /// (limits of strain), which the model also adds to the `explicit_momentum` of S2. Default:
  /// nothing. Collective.
  virtual void limit_motion(double, Vector&) {}
  /// x := x + dt * velocity from the stored positions (S1), and prescribed solids to time + dt.
  /// Collective.
  virtual void move(const Vector& velocity, double time, double dt) = 0;
  /// Called at the start of a step: puts back, when it is called in turn, all that `save` writes
  /// and a step changes. Calling that is collective. Default: nothing is put back.
  virtual std::function<void()> undo() {
    return [] {};
  }
  /// Where the last `move` carried the point x^n = x of a rigid solid (its number in this model);
  /// asked for nodes attached to it. Default, for models without rigid solids: x. Local.
  virtual Point<dim> carried(int solid, const Point<dim>& x) const;
  virtual std::vector<SolidState<dim>> states() const = 0;  ///< one per solid, on every rank
  /// Appends meshes with fields beyond the surface, for frames: what is inside, stress and strain.
  /// Default: nothing. Collective.
  virtual void add_frames(std::vector<SurfaceFrame>&) const {}
  /// Angular momentum about the origin that the inner forces of `explicit_momentum` give at the
  /// present positions [kg m^2/s]: zero but for laws that do not turn with the body, and forces
  /// taken elsewhere on its path. Asked for before `set_velocity`. Global, collective.
  virtual AngularVector<dim> inner_angular_impulse(double) const {
    return AngularVector<dim>::Zero();
  }
  /// Elements whose implicit forces were changed to keep C definite, in the last step that used
  /// them; for the history. Global, local call.
  virtual GlobalIndex n_clamped_elements() const { return 0; }
  /// Largest stable step of explicitly integrated forces [s]. Default: none.
  virtual double largest_stable_step() const;
};

template <int dim>
RCP<const LinearOperator> SolidModel<dim>::implicit_force(double) const {
  return Teuchos::null;
}
template <int dim>
Point<dim> SolidModel<dim>::carried(int, const Point<dim>& x) const {
  return x;
}
template <int dim>
double SolidModel<dim>::largest_stable_step() const {
  return 1e300;
}

}  // namespace lockstep
