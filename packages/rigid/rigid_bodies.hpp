#pragma once
#include <string>
#include <utility>
#include <vector>

#include "interfaces/solid_sides.hpp"
#include "parameters/parameter_list.hpp"
#include "rigid/rigid_body.hpp"

namespace lockstep {

/// All rigid bodies and rigid thin shells of a scene. Poses, velocities and momenta are replicated;
/// the dofs of the dynamic bodies, n_rigid_dofs each, lie in contiguous blocks of whole bodies on
/// the ranks. Angular velocities and momenta are in world axes about each body's reference point
/// (centre of mass, or pivot).
///
/// The momentum is state beside the velocity: `move` conserves it (angular momentum about the
/// centre of mass, or about a locked pivot), so that V_S* = M_S^-1 momentum at the new orientation
/// contains the gyroscopic effect. Free spin conserves angular momentum exactly, its energy stays
/// bounded, and it is second order in time.
template <int dim>
class RigidBodies : public SolidModel<dim>,
                    public AuditedSolids<dim>,
                    public JointableSolids<dim>,
                    public SolidOutput<dim> {
 public:
  /// gravity [m/s^2]; prescribed bodies are put where they are at `start_time` [s]. Collective.
  RigidBodies(std::vector<RigidBody<dim>> bodies, const Point<dim>& gravity,
              const Communicator& comm, double start_time = 0);

  std::string name() const override { return "rigid body"; }
  const AuditedSolids<dim>* audit() const override { return this; }
  const JointableSolids<dim>* jointable() const override { return this; }
  const SolidOutput<dim>* output() const override { return this; }
  const std::vector<RigidBody<dim>>& bodies() const { return bodies_; }
  double time() const { return time_; }  ///< time of the present positions [s]

  const std::vector<SolidDescription>& solids() const override { return solids_; }
  const SurfaceMesh<dim>& surface() const override { return surface_; }
  void velocity_row(const SurfacePoint<dim>& point, const Point<dim>& x,
                    VelocityRow<dim>& row) const override;
  Point<dim> prescribed_velocity(const SurfacePoint<dim>& point,
                                 const Point<dim>& x) const override;
  Point<dim> effective_velocity(const SurfacePoint<dim>& point, const Point<dim>& x) const override;

  RCP<const Map> dof_map() const override { return map_; }
  /// Block diagonal, a full block per body; a CrsMatrix.
  RCP<const LinearOperator> mass() const override { return mass_; }
  void set_gravity(const Point<dim>& gravity) override { gravity_ = gravity; }
  void begin_step(double, double) override { has_moved_ = false; }
  void explicit_momentum(double time, double dt, Vector& momentum) const override;
  void add_midpoint_correction(double dt, Vector& momentum) const override;
  Momentum<dim> external_impulse(double time, double dt) const override;
  std::vector<GlobalIndex> locked_dofs() const override;
  std::vector<Momentum<dim>> momentum_of_each(const Vector& generalized_momentum) const override;

  RCP<const Vector> velocity() const override;
  void set_velocity(const Vector& velocity) override;
  void move(const Vector& velocity, double time, double dt) override;
  Point<dim> carried(int solid, const Point<dim>& x) const override;
  std::vector<SolidState<dim>> states() const override;

  RigidFrame<dim> rigid_frame(int solid) const override;
  RigidFrame<dim> prescribed_frame(int solid, double time) const override;
  GlobalIndex first_dof(int solid) const override { return first_dof_[solid]; }
  std::string unjointable(int solid) const override;
  bool set_load(int solid, const Point<dim>& force, const AngularVector<dim>& torque) override;
  void add_frames(
      std::vector<SurfaceFrame>& frames) const override;  ///< surfaces of solids that no fluid sees

  /// Bit for bit. Throws InputError if the checkpoint holds other bodies.
  void save(CheckpointWriter& writer) const override;
  void load(const CheckpointReader& reader) override;

 private:
  const RigidBody<dim>& body_of(const SurfacePoint<dim>& point) const {
    return bodies_[body_of_simplex_[point.simplex]];
  }
  /// Values of all dynamic bodies, in their order, on every rank. Collective.
  std::vector<RigidVector<dim>> gather(const Vector& values) const;
  /// Sets (or adds) f(body) in the rows of this rank.
  template <typename Function>
  void for_each_own(const Function& f) const;
  /// Weight and the body's own load in a coupled solve over dt, in a step that began at `time`.
  Load<dim> load_on(const RigidBody<dim>& body, double time, double dt) const;
  /// Its impulse about the body's reference point.
  RigidVector<dim> load_impulse(const RigidBody<dim>& body, double time, double dt) const;
  void describe();
  void update_surface();
  std::vector<double> state() const;  ///< all that a step changes
  void set_state(const std::vector<double>& values);
  RCP<const LinearOperator> assemble_mass() const;

  Communicator comm_;
  Point<dim> gravity_;
  std::vector<RigidBody<dim>> bodies_;
  std::vector<int> dynamic_;         ///< indices of the dynamic bodies
  int own_begin_ = 0, own_end_ = 0;  ///< this rank's part of `dynamic_`
  std::vector<int> first_dof_;       ///< first dof of each body; -1 if prescribed
  std::vector<SolidDescription> solids_;
  std::vector<int> body_of_simplex_;
  SurfaceMesh<dim> surface_;
  RCP<const Map> map_;
  RCP<const LinearOperator> mass_;
  double time_ = 0;
  bool has_moved_ = false;  ///< in the present step
};

/// The model of all sublists of type "rigid body" of "Solids": names and validated lists (see
/// `rigid_body_parameters`), with absolute paths of files. Null if there are none. Collective.
template <int dim>
std::unique_ptr<RigidBodies<dim>> make_rigid_bodies(
    const std::vector<std::pair<std::string, ParameterList>>& bodies, double grid_spacing,
    const Point<dim>& gravity, const Communicator& comm, double start_time = 0);

}  // namespace lockstep
