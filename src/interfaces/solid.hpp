#pragma once
#include <vector>

#include "geometry/surface_snapshot.hpp"
#include "interfaces/momentum.hpp"
#include "interfaces/plug_in.hpp"
#include "interfaces/step_bound.hpp"
#include "linear/near_null_space.hpp"
#include "linear/types.hpp"

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
  Point<dim> velocity = Point<dim>::Zero();        ///< velocity of the centre of mass [m/s]
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
  std::string line;  ///< name of the line whose end it is; empty: it is a soft solid's
};

template <int dim>
class AuditedSolids;  // interfaces/solid_sides.hpp
template <int dim>
class JointableSolids;  // interfaces/solid_sides.hpp
template <int dim>
class NonlinearSolids;  // interfaces/solid_sides.hpp
template <int dim>
class SolidOutput;  // interfaces/solid_sides.hpp
template <int dim>
class VolumeSweeper;  // interfaces/volume_sweeper.hpp

/// All solids of one kind (all rigid bodies, all deformables, ...): their unknowns, mass, forces
/// and surfaces. Knows nothing of the fluid and nothing of other models.
///
/// Generalized velocities V_S live on `dof_map` (one-to-one; ranks may be empty, SolidSystem pads).
/// Prescribed (kinematic, static) solids have surfaces but no dofs. Audits, solvers and outputs
/// find more in interfaces/solid_sides.hpp.
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
  /// Velocity [m/s] of a prescribed solid's surface at the present time; zero for dynamic ones. A
  /// solid whose `states` tell no velocity counts as at rest, and is not asked again.
  /// Default, for models without prescribed solids: zero. Local.
  virtual Point<dim> prescribed_velocity(const SurfacePoint<dim>&, const Point<dim>&) const {
    return Point<dim>::Zero();
  }
  /// Displacement of the last `move` over its dt [m/s] at x^n (F2): for a rigid motion the twist
  /// log(relative pose)/dt at x; for nodes (x^{n+1} - x^n)/dt. Prescribed solids included. Local.
  virtual Point<dim> effective_velocity(const SurfacePoint<dim>& point,
                                        const Point<dim>& x) const = 0;

  // Operators with the geometry frozen.
  virtual RCP<const Map> dof_map() const = 0;
  /// The mass matrix M_S [kg], symmetric positive definite.
  virtual RCP<const LinearOperator> mass() const = 0;
  /// D(dt): symmetric negative semidefinite linearisation of the implicit forces [kg/s], or null.
  virtual RCP<const LinearOperator> implicit_force(double dt) const;
  /// The motions at the present positions that D does not resist, on `dof_map`, of models with
  /// nodes: the near null space of C, on which its multigrid inverses are built. Default: none,
  /// stiff solids are inverted by their diagonal. Collective.
  virtual RigidMotions near_null_space() const { return {}; }
  /// The solid of each local row of `dof_map`, asked of NonlinearSolids and VolumeSweepers alone:
  /// their rows are velocities of nodes, along all axes of one after those of another. Local.
  virtual std::vector<int> solid_of_row() const { return {}; }
  /// momentum = M_S V_S* = M_S V^n + dt (explicit forces, gravity included) [kg m/s]. Collective.
  virtual void explicit_momentum(double time, double dt, Vector& momentum) const = 0;
  /// S1 only, dt the half step: added to `explicit_momentum` so that its V_S* is the mean velocity
  /// of the whole step's motion, on whose way the inertia turns with the body; then the positions
  /// are second order in time. That motion sets out with the momentum at the begin, and with what
  /// else acts there if nothing takes it up. Never part of S2: momentum stays exact. Default:
  /// nothing. Collective.
  virtual void add_midpoint_correction(double, Vector&) const {}
  /// Steps are two kicks and a drift: implicit forces of each kick act over half a step, and both
  /// are kept. Before the first step; local. Default, for models without implicit forces: nothing.
  virtual void take_kicks() {}
  /// Gravity of the step that is about to begin [m/s^2], the same on all ranks. Default: nothing.
  /// Collective.
  virtual void set_gravity(const Point<dim>&) {}
  /// A step from `time` to time + dt begins: from here on `locked_dofs` are its own. Collective.
  virtual void begin_step(double, double) {}
  /// Dofs held at a given velocity in the present step (ids in dof_map, those of this rank). Local.
  virtual std::vector<GlobalIndex> locked_dofs() const { return {}; }
  /// Returns the mean velocity of each locked dof between two times; at equal times the velocity
  /// then. Default: zero. Local.
  virtual std::vector<double> locked_velocities(double, double) const {
    return std::vector<double>(locked_dofs().size(), 0);
  }
  /// This rank's nodes that solids of other models carry. The SolidSystem takes them out of the
  /// unknowns, and hands their velocities back with all others. Default: none. Local.
  virtual std::vector<NodeAttachment<dim>> attachments() const { return {}; }

  // State.
  virtual RCP<const Vector> velocity() const = 0;         ///< V_S
  virtual void set_velocity(const Vector& velocity) = 0;  ///< V_S := velocity (end of S2, contact)
  /// S1: velocities that are about to move the positions by dt, changed by internal impulses
  /// (limits of strain), which the model also adds to the `explicit_momentum` of S2. Default:
  /// nothing. Collective.
  virtual void limit_motion(double, Vector&) {}
  /// x := x + dt (velocity + drift) from the stored positions (S1), and prescribed solids to time
  /// + dt. Collective.
  virtual void move(const Vector& velocity, double time, double dt) = 0;
  /// Returns what nodes go beside their velocities in the coming `move`, over its dt [m/s], and
  /// after it in another one: the rest of an arc, of bodies that turn along. Contact counts with
  /// it. Null: nothing, the default; on all ranks or on none. Local.
  virtual RCP<const Vector> drift() const { return Teuchos::null; }
  /// Returns the position to which the last `move` carried the point x^n = x of a rigid solid (its
  /// number in this model); nodes attached to the solid ask for it. Default, for models without
  /// rigid solids: x. Local.
  virtual Point<dim> carried(int solid, const Point<dim>& x) const;
  virtual std::vector<SolidState<dim>> states() const = 0;  ///< one per solid, on every rank
  /// Longest stable step of explicitly integrated forces. Default: any is.
  virtual StepBound largest_stable_step() const { return {}; }
  /// Pushes a solid from the next step on, instead of the loads of the scene: a force at the centre
  /// of mass [N] and a torque about it [N m]. A program around a run calls it alike on all ranks,
  /// and again after a restart: checkpoints do not keep it. Returns false if these solids cannot be
  /// pushed, the default; throws InputError if this one is prescribed. Local.
  virtual bool set_load(int /*solid*/, const Point<dim>& /*force*/,
                        const AngularVector<dim>& /*torque*/) {
    return false;
  }

  // Sides: what else it can do, each an object of its own. Null: it cannot; the same in all of a
  // run and on all ranks. Local.

  virtual const AuditedSolids<dim>* audit() const { return nullptr; }
  virtual const JointableSolids<dim>* jointable() const { return nullptr; }
  virtual NonlinearSolids<dim>* nonlinear() { return nullptr; }  ///< null: not in this scene
  virtual const SolidOutput<dim>* output() const { return nullptr; }
  virtual const VolumeSweeper<dim>* sweeper() const { return nullptr; }
};

template <int dim>
RCP<const LinearOperator> SolidModel<dim>::implicit_force(double) const {
  return Teuchos::null;
}
template <int dim>
Point<dim> SolidModel<dim>::carried(int, const Point<dim>& x) const {
  return x;
}

}  // namespace lockstep
