#pragma once
#include <array>
#include <functional>
#include <memory>
#include <vector>

#include "coupling/attached_nodes.hpp"
#include "coupling/reduction.hpp"
#include "coupling/repeated_solids.hpp"
#include "coupling/stacked_operator.hpp"
#include "interfaces/block_system.hpp"
#include "interfaces/solid_sides.hpp"

namespace lockstep {

/// The stack of all solids: one surface, one space of generalized velocities. What it has together
/// is in solid_totals.hpp. The models' dofs follow one another; `reduction` says which of them are
/// unknowns of a solve (locked dofs and those of nodes that rigid solids carry are not). Vectors
/// are those of all dofs, but for what is said to be reduced. Every rank owns at least one row, if
/// need be an inert padding dof (unit mass, never coupled), because empty ranks break Thyra's block
/// vectors.
template <int dim>
class SolidSystem {
 public:
  /// `joints`: between solids of these models; null: none. Collective.
  SolidSystem(std::vector<std::unique_ptr<SolidModel<dim>>> models, const Communicator& comm,
              std::unique_ptr<ConstraintModel> joints = nullptr);

  int n_models() const { return static_cast<int>(models_.size()); }
  SolidModel<dim>& model(int m) { return *models_[m]; }
  const SolidModel<dim>& model(int m) const { return *models_[m]; }
  /// True if there are any unknowns, on any rank.
  bool has_unknowns() const { return n_unknowns_ > 0; }
  bool empty() const { return solids_.empty(); }
  GlobalIndex n_unknowns() const { return n_unknowns_; }  ///< without padding
  RCP<const Map> map() const { return map_; }             ///< never null
  const Communicator& comm() const { return comm_; }

  /// Lets closed solids that move freely, attached to no other, go round a domain with periodic
  /// axes: snapshots show them wherever it has them, up to `margin` [m] beyond its sides. Before
  /// the first snapshot. Collective.
  void go_round(const Box<dim>& domain, const std::array<bool, dim>& periodic, double margin);
  const RepeatedSolids<dim>& repeated() const { return repeated_; }  ///< solids that go round
  /// Returns the image of x that is nearest to the solid's own place, which goes on beyond periodic
  /// sides; x itself if the solid is not repeated. Local.
  Point<dim> own_place(int solid, const Point<dim>& x) const {
    return repeated_.own_place(solid, x);
  }

  /// The surfaces of all models at the present positions, one after the other, each at its own
  /// place.
  SurfaceMesh<dim> surface() const;
  /// Returns a snapshot of this surface for geometric queries. Solids are numbered over all models.
  /// With `before`, a snapshot of earlier positions, all images that either needs are shown.
  std::shared_ptr<const SurfaceSnapshot<dim>> snapshot(
      const SurfaceSnapshot<dim>* before = nullptr) const;
  const std::vector<SolidDescription>& solids() const { return solids_; }
  std::vector<SolidState<dim>> states() const;

  /// Rows of a surface point of the last snapshot, with ids of `map`. Of a repeated solid they are
  /// those of the image nearest to x. Local.
  void velocity_row(const SurfacePoint<dim>& point, const Point<dim>& x,
                    VelocityRow<dim>& row) const;
  /// Makes the row of a point of a rigid solid that is not prescribed, with a surface or without.
  /// Local.
  void rigid_row(int solid, const Point<dim>& x, VelocityRow<dim>& row) const {
    lockstep::rigid_row(models_, begin_, solids_[solid], own_place(solid, x), row);
  }
  /// This rank's nodes that rigid solids carry, at the present positions.
  const std::vector<AttachedNode<dim>>& attached() const { return attached_; }
  Point<dim> prescribed_velocity(const SurfacePoint<dim>& point, const Point<dim>& x) const;
  Point<dim> effective_velocity(const SurfacePoint<dim>& point, const Point<dim>& x) const;

  /// P^T (M_S + added - dt D) P, the reduced block, with unit rows for padding. Assembled if all
  /// models are, else matrix-free. `added` may be null. Collective.
  RCP<const LinearOperator> solid_block(const RCP<const CrsMatrix>& added, double dt) const;
  /// M_S + added - dt D of all dofs; padding rows are zero. Applied part by part.
  RCP<const LinearOperator> full_block(const RCP<const CrsMatrix>& added, double dt) const;
  /// P^T M P where M is M_S, but of models whose masses do not fall apart into small blocks (those
  /// of consistent mass matrices) the sums of its rows. Collective.
  RCP<const CrsMatrix> lumped_block() const;
  /// The inverse of P^T M_S P, kept until a model has another mass or other dofs are unknowns: then
  /// it is another object. Collective, and so is every application.
  RCP<const LinearOperator> mass_inverse() const;
  /// The models' dofs in vectors of this rank, by the models' names.
  std::vector<Block> blocks() const;
  /// Velocity of the solids without fluid: V = P y + b with P^T (M_S - dt D) V = P^T q for a
  /// stacked momentum q. `inverse`: of `solid_block` without added mass. Collective.
  RCP<Vector> velocity_of(const Vector& momentum, double dt, const Reduction& constraints,
                          const LinearOperator& inverse) const;
  /// Velocity of the solids without fluid, with `solid_block` factored anew.
  RCP<Vector> velocity_of(const Vector& momentum, double dt, const Reduction& constraints) const;
  /// Velocity of the solids without fluid by M_S alone, given dofs at rest.
  RCP<Vector> velocity_of(const Vector& momentum) const {
    return velocity_of(momentum, 0, reduction_);
  }
  /// M_S alone; padding rows are zero. Applied part by part.
  RCP<const LinearOperator> mass() const { return full_block(Teuchos::null, 0); }
  void take_kicks();                            ///< steps are two kicks and a drift
  void set_gravity(const Point<dim>& gravity);  ///< takes that of the next step [m/s^2]
  /// A step begins: true if other dofs are unknowns than before, on any rank. Collective.
  bool begin_step(double time, double dt);
  /// P at the present positions, locked dofs at rest.
  const Reduction& reduction() const { return reduction_; }
  /// P at the present positions with the mean velocities of locked dofs between two times
  /// (`SolidModel::locked_velocities`), and with `ClosedMotion::constraint_error`; null: none.
  /// Collective.
  Reduction constraints(double begin, double end,
                        const RCP<const Vector>& constraint_error = {}) const;
  ConstraintModel* joints() { return joints_.get(); }  ///< null: there are none
  const ConstraintModel* joints() const { return joints_.get(); }

  /// Returns a model's part of a stacked vector, as a view. Local.
  RCP<const Vector> part(const Vector& stacked, int m) const;
  RCP<Vector> part(Vector& stacked, int m) const;
  /// Stacked vectors. Collective.
  RCP<Vector> velocity() const;  ///< carried nodes move as their solids
  void set_velocity(const Vector& velocity);
  RCP<Vector> explicit_momentum(double time, double dt) const;
  void add_midpoint_correction(double dt, Vector& momentum) const;
  /// Linearises all models' implicit forces; false if there are none. Collective.
  bool linearise(double dt, const Vector& velocity);
  /// Another number after anything that changes the implicit forces: a step that begins or
  /// linearises anew, a motion, velocities. Local.
  unsigned linearisation_number() const { return linearisation_number_; }
  /// The model's side of nonlinear forces, or null.
  NonlinearSolids<dim>* nonlinear(int m) const { return models_[m]->nonlinear(); }
  void limit_motion(double dt, Vector& velocity);
  void move(const Vector& velocity, double time, double dt);
  /// Stacked `SolidModel::drift`; null: nothing drifts.
  RCP<const Vector> drift() const;
  /// Linear and angular momentum of each solid, and of all, for a stacked generalized momentum.
  /// Collective.
  std::vector<Momentum<dim>> momentum_of_each(const Vector& generalized_momentum) const;
  Momentum<dim> momentum(const Vector& generalized_momentum) const;

 private:
  void find_reduction();
  void move_attached(const Vector& velocity, double time, double dt);
  /// A surface point as its model knows it, at its own place.
  struct ModelPoint {
    int model = 0;
    SurfacePoint<dim> point;
    Point<dim> x;
  };
  ModelPoint in_model(SurfacePoint<dim> point, const Point<dim>& x) const;
  std::vector<StackedPart> parts(double dt) const;
  std::vector<int> padding_rows() const;

  Communicator comm_;
  std::vector<std::unique_ptr<SolidModel<dim>>> models_;
  std::unique_ptr<ConstraintModel> joints_;
  std::vector<SolidDescription> solids_;
  mutable BoxOrder order_;  ///< order of boxes in snapshots
  RCP<const Map> map_;
  std::vector<ModelBegin> begin_;  ///< begin of each model
  GlobalIndex n_unknowns_ = 0;
  int n_padding_ = 0;  ///< local
  unsigned linearisation_number_ = 0;
  std::vector<char> carried_;                ///< models with attached nodes, on any rank
  std::vector<AttachedNode<dim>> attached_;  ///< this rank's nodes, at the present positions
  Reduction reduction_;
  mutable RCP<const LinearOperator> mass_inverse_;            ///< null: not asked for yet
  mutable std::vector<RCP<const LinearOperator>> of_masses_;  ///< mass operators of the models
  mutable RepeatedSolids<dim> repeated_;
};

}  // namespace lockstep
