#pragma once
#include <vector>

#include "interfaces/solid_sides.hpp"

namespace lockstep {

/// One solid of a FakeSolid.
template <int dim>
struct FakeBody {
  enum class Kind { rigid, nodal, prescribed };
  std::string name = "body";
  Kind kind = Kind::rigid;
  SurfaceMesh<dim> surface;  ///< at its place [m]
  bool closed = true;
  double mass = 1;     ///< [kg]; nodes share it equally
  double inertia = 1;  ///< about `center`, the same for every axis [kg m^2]; rigid only
  Point<dim> center = Point<dim>::Zero();    ///< centre of mass and of rotation [m]
  Point<dim> velocity = Point<dim>::Zero();  ///< velocity of the centre, or of every node [m/s]
  AngularVector<dim> angular_velocity = AngularVector<dim>::Zero();  ///< [rad/s]
  std::vector<int> locked;  ///< its own dofs that are held: translations, then rotations; or
                            ///< dim * node + axis
};

template <int dim>
struct FakeSolidOptions {
  bool matrix_free = false;                 ///< M_S and D without assembled matrix
  double damping = 0;                       ///< D = -damping on every dof [kg/s]
  Point<dim> gravity = Point<dim>::Zero();  ///< [m/s^2]
};

/// The solid partner in tests: rigid bodies, loose nodes and prescribed surfaces with a diagonal
/// mass. State is replicated; the dofs are dealt to the ranks in equal shares, wherever a body
/// ends.
template <int dim>
class FakeSolid : public SolidModel<dim>, public AuditedSolids<dim> {
 public:
  FakeSolid(std::vector<FakeBody<dim>> bodies, const FakeSolidOptions<dim>& options,
            const Communicator& comm);

  std::string name() const override { return "fake solid"; }
  const AuditedSolids<dim>* audit() const override { return this; }
  void save(CheckpointWriter& checkpoint) const override;
  void load(const CheckpointReader& checkpoint) override;
  const std::vector<SolidDescription>& solids() const override { return solids_; }
  const SurfaceMesh<dim>& surface() const override { return surface_; }
  void velocity_row(const SurfacePoint<dim>& point, const Point<dim>& x,
                    VelocityRow<dim>& row) const override;
  Point<dim> prescribed_velocity(const SurfacePoint<dim>& point,
                                 const Point<dim>& x) const override;
  Point<dim> effective_velocity(const SurfacePoint<dim>& point, const Point<dim>& x) const override;
  RCP<const Map> dof_map() const override { return map_; }
  RCP<const LinearOperator> mass() const override { return mass_; }
  RCP<const LinearOperator> implicit_force(double dt) const override;
  void explicit_momentum(double time, double dt, Vector& momentum) const override;
  Momentum<dim> external_impulse(double time, double dt) const override;
  std::vector<GlobalIndex> locked_dofs() const override;
  std::vector<Momentum<dim>> momentum_of_each(const Vector& generalized_momentum) const override;
  RCP<const Vector> velocity() const override;
  void set_velocity(const Vector& velocity) override;
  void move(const Vector& velocity, double time, double dt) override;
  std::vector<SolidState<dim>> states() const override;

 private:
  using Kind = typename FakeBody<dim>::Kind;
  /// All numbers that a step changes.
  std::vector<double> state() const;
  void set_state(const std::vector<double>& values);
  int body_of(int simplex) const;
  /// Velocity of a surface point for these values of all dofs (prescribed: its own motion).
  Point<dim> velocity_at(const std::vector<double>& dofs, const SurfacePoint<dim>& point,
                         const Point<dim>& x) const;
  RCP<const LinearOperator> diagonal(const std::vector<double>& entries) const;
  std::vector<double> everywhere(const Vector& values) const;

  std::vector<FakeBody<dim>> bodies_;
  FakeSolidOptions<dim> options_;
  Communicator comm_;
  std::vector<SolidDescription> solids_;
  SurfaceMesh<dim> surface_;
  std::vector<int> first_dof_;         ///< first dof of each body
  std::vector<double> masses_;         ///< the diagonal of M_S, all dofs
  std::vector<double> velocity_;       ///< V_S, all dofs
  std::vector<double> last_velocity_;  ///< velocity of the last `move`
  RCP<const Map> map_;
  RCP<const LinearOperator> mass_;
};

}  // namespace lockstep
