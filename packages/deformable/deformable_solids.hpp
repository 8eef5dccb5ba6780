#pragma once
#include <array>
#include <initializer_list>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "deformable/deformable_body.hpp"
#include "deformable/node_space.hpp"
#include "deformable/strain_limit.hpp"
#include "interfaces/energy.hpp"
#include "interfaces/solid_sides.hpp"
#include "interfaces/volume_sweeper.hpp"
#include "parameters/parameter_list.hpp"

namespace lockstep {

struct SubSteps;

/// All deformable bodies of a scene: volumes of finite elements and thin shells. The dofs are the
/// velocities of the nodes, distributed by METIS; the surface is replicated.
///
/// Explicit elastic forces are those at the present positions. Implicit ones make, for one mode of
/// stiffness m omega^2 and a = omega dt, b = 1 + a^2/2, together with the step the map
/// x' = (x + (1 + c a^2) dt v)/b, v' = (v - dt omega^2 x')/(1 + a^2), whose energy falls by 3/2 a^2
/// of itself a step. Second order has v' = (v - dt omega^2 x)/(1 + a^2/2), the force at
/// x + v' dt/2; its energy falls by a^4/8 where a is small. c is 1/4, of second order 1/8, where
/// the step resolves the motion and 0 where it does not: see add_midpoint_correction. Explicit and
/// semi-implicit are stable up to a = sqrt 2.
template <int dim>
class DeformableSolids : public SolidModel<dim>,
                         public AuditedSolids<dim>,
                         public NonlinearSolids<dim>,
                         public NearNullSpaces<dim>,
                         public SolidOutput<dim>,
                         public VolumeSweeper<dim>,
                         public WorkingSolids<dim> {
 public:
  /// `type` is the name of the model, gravity [m/s^2], the start of the run [s]. Collective.
  DeformableSolids(const std::string& type, std::vector<DeformableBody<dim>> bodies,
                   const Point<dim>& gravity, const Communicator& comm, double start_time = 0);

  std::string name() const override { return type_; }

  const std::vector<SolidDescription>& solids() const override { return solids_; }
  const SurfaceMesh<dim>& surface() const override { return surface_; }
  void velocity_row(const SurfacePoint<dim>& point, const Point<dim>& x,
                    VelocityRow<dim>& row) const override;
  Point<dim> effective_velocity(const SurfacePoint<dim>& point, const Point<dim>& x) const override;

  RCP<const Map> dof_map() const override { return space_.dof_map(); }
  /// A CrsMatrix; diagonal where the mass is lumped.
  RCP<const LinearOperator> mass() const override { return mass_; }
  /// Returns a CrsMatrix, or null if all bodies are explicit. It takes rigid motions to zero, but
  /// for the torque of fully implicit elasticity, which turns the present forces with the body.
  RCP<const LinearOperator> implicit_force(double dt) const override;
  RigidMotions near_null_space() const override;
  void explicit_momentum(double time, double dt, Vector& momentum) const override;
  void add_midpoint_correction(double dt, Vector& momentum) const override;
  Momentum<dim> external_impulse(double time, double dt) const override;
  void begin_step(double time, double dt) override;
  std::vector<GlobalIndex> locked_dofs() const override;
  std::vector<double> locked_velocities(double begin, double end) const override {
    return held_.velocities(begin, end);
  }
  std::vector<NodeAttachment<dim>> attachments() const override;
  std::vector<Momentum<dim>> momentum_of_each(const Vector& generalized_momentum) const override;

  RCP<const Vector> velocity() const override { return velocity_; }
  void set_velocity(const Vector& velocity) override;
  bool linearise(double dt, const Vector& velocity) override;
  bool has_implicit_forces() const override;
  RCP<const Vector> linearisation() const override { return linearisation_; }
  std::vector<ComputedEnergy> nonlinear_energies(double dt, const Vector& velocity) const override;
  SolidWork solid_work(double time, double dt, const Vector& velocity,
                       const Vector& mean) const override;
  void limit_motion(double dt, Vector& velocity) override;
  void move(const Vector& velocity, double time, double dt) override;
  std::vector<SolidState<dim>> states() const override { return states_; }
  void add_frames(std::vector<SurfaceFrame>& frames) const override;
  /// Angular impulse of linear elasticity of turned bodies, of means over sub-steps, and of the
  /// stretch limit of S1.
  AngularVector<dim> inner_angular_impulse(double dt) const override;
  double largest_stable_step() const override { return largest_stable_step_; }

  std::vector<char> can_sweep(const Box<dim>& domain) const override;
  RCP<const Vector> swept_per_velocity() const override;
  std::vector<int> solid_of_row() const override;
  void sweep(double dt, const std::vector<double>& volumes, Vector& velocity) const override;

  /// Saves the state, bit for bit on the same ranks; `load` throws InputError if the checkpoint
  /// holds other bodies.
  void save(CheckpointWriter& writer) const override;
  void load(const CheckpointReader& reader) override;

  GlobalIndex n_clamped_elements() const override { return n_clamped_; }
  double stretch_beyond_limit() const override { return stretch_beyond_limit_; }
  /// Owned nodes: their numbers in the order of the bodies, positions [m] and elastic forces [N].
  const NodeSpace<dim>& nodes() const { return space_; }
  const std::vector<Point<dim>>& positions() const { return x_; }
  const std::vector<Point<dim>>& elastic_forces() const { return elastic_force_; }

 private:
  using Nodes = std::vector<Point<dim>>;
  /// Constant properties of a body, on this rank.
  struct Body {
    std::string name;
    bool closed = true, consistent_mass = false;
    TimeIntegration integration = TimeIntegration::semi_implicit;
    int most_sub_steps = 1;
    double elastic_step = 1e300;       ///< stable at the present positions, without sub-steps [s]
    double stiffest_rate = 0;          ///< a bound of the frequencies at the start [1/s]
    double softening = 1;              ///< factor of the elastic forces in this step [1]
    double mass = 0, measure = 0;      ///< [kg]; volume (cloth: area) as meshed
    double fluid_mass = 0;             ///< mass of fluid that it carries along, about [kg]
    int node_begin = 0, node_end = 0;  ///< original numbers
    std::vector<std::unique_ptr<ElementGroup<dim>>> elements;
    double elastic_energy = 0;  ///< energy on all ranks
  };

  void add_body(DeformableBody<dim>& body, int node_begin);
  void make_strain_limit(const std::vector<DeformableBody<dim>>& bodies);
  void hold_nodes(const std::vector<DeformableBody<dim>>& bodies);
  void distribute(std::vector<DeformableBody<dim>>& bodies, const Communicator& comm);
  void assemble_mass(const std::vector<DeformableBody<dim>>& bodies);
  void distribute_surface(const std::vector<DeformableBody<dim>>& bodies);
  /// Updates surface, forces, linearisation and states after the positions have changed.
  void update_geometry();
  void update_within_surface();  ///< updates all but the surface
  void update_forces();
  /// Time after which the elastic forces of the coming solve are taken, as a part of the solve's dt
  /// [1]: in S1 the end of the step, two halves of it, in S2 its end or its middle; 0 where D has
  /// no elasticity.
  double elastic_share(const Body& body) const;
  /// Assembles forces, stiffness and damping at positions x of all local nodes.
  void assemble_forces(const Nodes& x);
  void update_largest_stable_step();
  void bound_frequencies();
  void soften(double dt);
  double least_mass(int node) const;  ///< a bound of the eigenvalues of M_S [kg]
  /// Elastic forces for a step: averaged over sub-steps where the step is longer than a body's
  /// stable one; computed once for the same positions.
  const Nodes& averaged_forces() const;
  /// Averages the elastic forces of bodies with these sub-steps.
  void average_forces(const std::vector<int>& bodies, const SubSteps& steps, Nodes& force) const;
  void check_finite(const Nodes& averaged) const;
  /// The local nodes of a body: owned ones, ghosts.
  std::array<std::array<int, 2>, 2> nodes_of(int body) const;
  void update_states();
  Nodes mobility() const;
  /// Several values of this rank's nodes at all vertices of the surface, by one message.
  /// Collective.
  std::vector<Nodes> surface_values(std::initializer_list<const Nodes*> of_nodes) const;
  std::array<Point<dim>, dim> of_corners(int simplex, const Nodes& of_vertices) const;
  void find_boundary_nodes();
  std::vector<char> free_boundary_nodes() const;
  Nodes area_shares() const;
  Nodes swelling() const;
  int body_of_node(int local) const { return body_of_node_[local]; }

  std::string type_;
  Communicator comm_;
  Point<dim> gravity_;
  std::vector<Body> bodies_;
  NodeSpace<dim> space_;
  std::vector<int> body_of_node_;   ///< body of the local nodes
  std::vector<double> node_mass_;   ///< lumped, of the owned nodes [kg]
  std::vector<double> node_share_;  ///< share of the owned nodes in their body's measure, sum 1
  Nodes node_force_;                ///< constant loads on them [N]
  HeldNodes<dim> held_;
  std::vector<std::pair<int, std::string>> attached_;  ///< owned nodes and their carriers

  std::vector<SolidDescription> solids_;
  SurfaceMesh<dim> surface_;
  std::vector<GlobalIndex> surface_node_;       ///< global number of each vertex
  std::vector<int> own_surface_vertices_;       ///< local nodes, in the order of gathering
  std::vector<int> gathered_surface_vertices_;  ///< the vertex of each gathered value
  Nodes surface_velocity_;                      ///< velocity of the last move [m/s]
  std::vector<int> boundary_nodes_;             ///< owned ones, where shells end

  StrainLimit<dim> strain_limit_;
  double stretch_beyond_limit_ = 0;
  Nodes limiting_impulse_;  ///< impulse of the last `limit_motion`, until S2 has used it [kg m/s]

  RCP<const LinearOperator> mass_;
  NodeMatrix<dim> stiffness_, damping_;
  mutable RCP<const LinearOperator> implicit_force_;  ///< null: not asked for yet
  mutable double implicit_force_dt_ = 0;              ///< [s]
  Nodes x_;                                           ///< positions of all local nodes [m]
  /// Positions at the start of the step [m], from `move` to the end of the step, if bodies are of
  /// second order. Null on all ranks or on none, with nodes or without.
  std::optional<Nodes> before_;
  Nodes elastic_force_;                          ///< force on the owned nodes [N]
  mutable std::optional<Nodes> averaged_force_;  ///< none: not asked for yet
  RCP<const Vector> velocity_;
  std::vector<SolidState<dim>> states_;
  Momentum<dim> load_;  ///< gravity and loads, of all ranks [N]
  double largest_stable_step_ = 1e300;
  double step_ = 0;                  ///< the present one [s]
  bool moved_ = false;               ///< the coming solve is S2
  bool linearised_ = false;          ///< elsewhere than at x_
  RCP<const Vector> linearisation_;  ///< the velocity that leads there; null: zero
  GlobalIndex n_clamped_ = 0;
};

}  // namespace lockstep
