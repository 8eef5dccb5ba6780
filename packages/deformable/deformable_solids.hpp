#pragma once
#include <string>
#include <vector>

#include "deformable/explicit_elasticity.hpp"
#include "deformable/implicit_forces.hpp"
#include "deformable/nodal_surface.hpp"
#include "deformable/strain_limit.hpp"
#include "deformable/volume_sweep.hpp"
#include "interfaces/energy.hpp"

namespace lockstep {

/// All deformable bodies of a scene: volumes of finite elements and thin shells. The dofs are the
/// velocities of the nodes, distributed by METIS; the surface is replicated.
template <int dim>
class DeformableSolids : public SolidModel<dim>,
                         public AuditedSolids<dim>,
                         public SolidOutput<dim> {
 public:
  /// `type` is the name of the model, gravity [m/s^2], the start of the run [s]. Collective.
  DeformableSolids(const std::string& type, const std::vector<DeformableBody<dim>>& bodies,
                   const Point<dim>& gravity, const Communicator& comm, double start_time = 0);

  std::string name() const override { return type_; }
  const AuditedSolids<dim>* audit() const override { return this; }
  NonlinearSolids<dim>* nonlinear() override { return implicit_.any() ? &implicit_ : nullptr; }
  const SolidOutput<dim>* output() const override { return this; }
  const VolumeSweeper<dim>* sweeper() const override { return &sweep_; }

  const std::vector<SolidDescription>& solids() const override { return surface_.solids(); }
  const SurfaceMesh<dim>& surface() const override { return surface_.mesh(); }
  void velocity_row(const SurfacePoint<dim>& point, const Point<dim>&,
                    VelocityRow<dim>& row) const override {
    surface_.velocity_row(point, row);
  }
  Point<dim> effective_velocity(const SurfacePoint<dim>& point, const Point<dim>&) const override {
    return surface_.velocity_at(point);
  }

  RCP<const Map> dof_map() const override { return nodes_.space.dof_map(); }
  /// A CrsMatrix; diagonal where the mass is lumped.
  RCP<const LinearOperator> mass() const override { return nodes_.mass_matrix; }
  /// Returns a CrsMatrix, or null if all bodies are explicit. It takes rigid motions to zero, but
  /// for the torque of fully implicit elasticity, which turns the present forces with the body.
  RCP<const LinearOperator> implicit_force(double dt) const override {
    return implicit_.implicit_force(dt);
  }
  std::vector<int> solid_of_row() const override;
  RigidMotions near_null_space() const override;
  void explicit_momentum(double time, double dt, Vector& momentum) const override;
  void add_midpoint_correction(double dt, Vector& momentum) const override {
    implicit_.add_midpoint_correction(dt, momentum);
  }
  void set_gravity(const Point<dim>& gravity) override;
  void begin_step(double time, double dt) override;
  std::vector<GlobalIndex> locked_dofs() const override;
  std::vector<double> locked_velocities(double begin, double end) const override {
    return nodes_.held.velocities(begin, end);
  }
  std::vector<NodeAttachment<dim>> attachments() const override;

  RCP<const Vector> velocity() const override { return nodes_.velocity; }
  void set_velocity(const Vector& velocity) override;
  void limit_motion(double dt, Vector& velocity) override;
  void move(const Vector& velocity, double time, double dt) override;
  RCP<const Vector> drift() const override;
  std::vector<SolidState<dim>> states() const override { return states_; }
  StepBound largest_stable_step() const override { return explicit_.largest_stable_step(); }

  Momentum<dim> external_impulse(double, double dt) const override {
    return {dt * load_.linear, dt * load_.angular};
  }
  std::vector<Momentum<dim>> momentum_of_each(const Vector& generalized_momentum) const override;
  /// Angular impulse of linear elasticity of turned bodies, of means over sub-steps, and of the
  /// stretch limit of S1.
  AngularVector<dim> inner_angular_impulse(double dt) const override;
  std::optional<SolidWork> solid_work(double time, double dt, const Vector& velocity,
                                      const Vector& mean) const override;
  void add_frames(std::vector<SurfaceFrame>& frames) const override;
  GlobalIndex n_clamped_elements() const override { return forces_.n_clamped; }
  double stretch_beyond_limit() const override { return stretch_beyond_limit_; }

  /// Saves the state, bit for bit on the same ranks; `load` throws InputError if the checkpoint
  /// holds other bodies.
  void save(CheckpointWriter& writer) const override;
  void load(const CheckpointReader& reader) override;

  /// Owned nodes: their numbers in the order of the bodies, positions [m] and elastic forces [N].
  const NodeSpace<dim>& nodes() const { return nodes_.space; }
  const std::vector<Point<dim>>& positions() const { return nodes_.x; }
  const std::vector<Point<dim>>& elastic_forces() const { return forces_.elastic; }

 private:
  using Nodes = std::vector<Point<dim>>;
  void find_load();
  void update();  ///< updates forces, their bounds and states after the positions have changed

  std::string type_;
  BodyNodes<dim> nodes_;
  NodalSurface<dim> surface_;
  BodyTurn<dim> turn_;
  ElementForces<dim> forces_;
  ImplicitForces<dim> implicit_;
  ExplicitElasticity<dim> explicit_;
  double step_ = 0;  ///< length of the step that laws with a memory have not ended yet [s]
  std::vector<SolidState<dim>> states_;
  VolumeSweep<dim> sweep_;
  StrainLimit<dim> strain_limit_;
  double stretch_beyond_limit_ = 0;
  Nodes limiting_impulse_;  ///< impulse of the last `limit_motion`, until S2 has used it [kg m/s]
  Momentum<dim> load_;      ///< gravity and loads, of all ranks [N]
};

}  // namespace lockstep
