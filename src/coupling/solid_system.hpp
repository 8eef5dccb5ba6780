#pragma once
#include <functional>
#include <memory>
#include <vector>

#include "coupling/attachments.hpp"
#include "coupling/stacked_operator.hpp"
#include "interfaces/solid_sides.hpp"

namespace lockstep {

/// The stack of all solids: one surface, one space of generalized velocities. The models' dofs
/// follow one another; dofs of nodes attached to rigid solids are not unknowns (zero in all
/// vectors, see `Attachments`); every rank owns at least one row, if need be an inert padding dof
/// (unit mass, never coupled), because empty ranks break Thyra's block vectors.
template <int dim>
class SolidSystem {
 public:
  /// Collective.
  SolidSystem(std::vector<std::unique_ptr<SolidModel<dim>>> models, const Communicator& comm);

  int n_models() const { return static_cast<int>(models_.size()); }
  SolidModel<dim>& model(int m) { return *models_[m]; }
  const SolidModel<dim>& model(int m) const { return *models_[m]; }
  /// Any unknowns at all, on any rank?
  bool has_unknowns() const { return n_unknowns_ > 0; }
  bool empty() const { return solids_.empty(); }
  GlobalIndex n_unknowns() const { return n_unknowns_; }  ///< without padding
  RCP<const Map> map() const { return map_; }             ///< never null
  const Communicator& comm() const { return comm_; }

  /// The surfaces at the present positions. Solids are numbered over all models.
  std::shared_ptr<const SurfaceSnapshot<dim>> snapshot() const;
  const std::vector<SolidDescription>& solids() const { return solids_; }
  std::vector<SolidState<dim>> states() const;
  /// Largest 1-norm of the velocity of a surface vertex, each solid taken as rigid [m/s]. Local.
  double largest_surface_speed() const;

  /// Rows of a surface point of a snapshot, with ids of `map`. Local.
  void velocity_row(const SurfacePoint<dim>& point, const Point<dim>& x,
                    VelocityRow<dim>& row) const;
  Point<dim> prescribed_velocity(const SurfacePoint<dim>& point, const Point<dim>& x) const;
  Point<dim> effective_velocity(const SurfacePoint<dim>& point, const Point<dim>& x) const;

  /// M_S + added - dt D with unit rows for padding and, symmetrically eliminated, for locked dofs.
  /// Assembled if all models are, else matrix-free. `added` may be null. Collective.
  RCP<const LinearOperator> solid_block(const RCP<const CrsMatrix>& added, double dt) const;
  /// The same without eliminating locked dofs, for their reactions; padding rows are zero. Applied
  /// part by part.
  RCP<const LinearOperator> unlocked_block(const RCP<const CrsMatrix>& added, double dt) const;
  /// The models' near null spaces on `map`, with the masses M_S + added. Collective.
  NearNullSpace near_null_space(const RCP<const CrsMatrix>& added) const;
  /// M_S^-1 q: the velocities of a stacked generalized momentum. Collective.
  RCP<Vector> velocity_of(const Vector& generalized_momentum) const;
  /// M_S alone, locked dofs included; padding rows are zero. Applied part by part.
  RCP<const LinearOperator> mass() const;
  /// A step begins: true if other dofs are locked than before, on any rank. Collective.
  bool begin_step(double time, double dt);
  /// 1 for free dofs, 0 for locked, attached and padding ones.
  RCP<const Vector> free_mask() const { return free_mask_; }
  bool has_locks() const { return has_locks_; }
  /// True for dofs of a rigid solid that nodes are attached to. Local.
  bool carries_nodes(GlobalIndex dof) const { return attachments_.is_carrier(dof); }
  /// The velocities at which dofs are locked, zero elsewhere (`SolidModel::locked_velocities`);
  /// null if all are zero. Collective.
  RCP<const Vector> locked_velocity(double begin, double end) const;

  /// Stacked vectors. Collective.
  RCP<Vector> velocity() const;
  void set_velocity(const Vector& velocity);
  RCP<Vector> explicit_momentum(double time, double dt) const;
  /// `implicit_part`: of it, for models with implicit forces [1].
  void add_midpoint_correction(double dt, double implicit_part, Vector& momentum) const;
  /// dt D V: what the implicit forces give in a step. Its sum is zero, but not its torque: forces
  /// linearised at x act at x + dt V. Collective.
  RCP<Vector> implicit_impulse(double dt, const Vector& velocity) const;
  AngularVector<dim> inner_angular_impulse(double dt) const;  ///< of all models [kg m^2/s]
  Momentum<dim> external_impulse(double time, double dt) const;
  bool linearise(double dt, const Vector& velocity);
  /// Of any model, and of all: see UnlinearSolids.
  bool has_implicit_forces() const;
  RCP<const Vector> linearisation() const;
  ComputedEnergy unlinear_energy(double dt, const Vector& velocity) const;
  void limit_motion(double dt, Vector& velocity);
  void move(const Vector& velocity, double time, double dt);
  /// `SolidModel::undo` of all models. Calling what it returns is collective.
  std::function<void()> undo();
  /// Linear and angular momentum of each solid, and of all, for a stacked generalized momentum.
  /// Collective.
  std::vector<Momentum<dim>> momentum_of_each(const Vector& generalized_momentum) const;
  Momentum<dim> momentum(const Vector& generalized_momentum) const;
  double largest_stable_step() const;
  GlobalIndex n_clamped_elements() const;  ///< of all models, see SolidOutput
  /// True if all models tell their momentum (AuditedSolids).
  bool is_audited() const;

 private:
  /// A side interface of a model, or null.
  template <typename Side>
  const Side* side(int m) const {
    return side_of<Side>(model(m));
  }
  /// The same of forces that are not linear, if it has any in this scene.
  const UnlinearSolids<dim>* unlinear(int m) const;
  void move_attached(const Vector& velocity, double time, double dt);
  std::pair<int, SurfacePoint<dim>> in_model(const SurfacePoint<dim>& point) const;
  RCP<const Vector> part(const Vector& stacked, int m) const;
  RCP<Vector> part(Vector& stacked, int m) const;
  void make_free_mask();
  std::vector<StackedPart> parts(double dt) const;
  std::vector<int> padding_rows() const;
  RCP<CrsMatrix> reduced_matrix(const std::vector<StackedPart>& parts, double dt,
                                const RCP<const CrsMatrix>& added) const;
  RCP<const LinearOperator> block(const RCP<const CrsMatrix>& added, double dt,
                                  bool eliminate) const;

  Communicator comm_;
  std::vector<std::unique_ptr<SolidModel<dim>>> models_;
  std::vector<SolidDescription> solids_;
  RCP<const Map> map_;
  std::vector<ModelBegin> begin_;  ///< of each model
  GlobalIndex n_unknowns_ = 0;
  int n_padding_ = 0;  ///< local
  Attachments<dim> attachments_;
  RCP<Vector> free_mask_;
  bool has_locks_ = false;
};

}  // namespace lockstep
