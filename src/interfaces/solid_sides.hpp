#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "interfaces/energy.hpp"
#include "interfaces/solid.hpp"
#include "motion/rotation.hpp"

namespace lockstep {

struct SurfaceFrame;  // output/frames.hpp

// Sides of solid models (SolidModel::audit, ...) for audits, solvers and outputs. The SolidSystem
// asks each of its models and does without.

/// Momentum and work, for the ledger, the budget of energy and the forces that are reported.
/// Without it a run has no `momentum_error`, and the forces on these solids are zero in its tables.
template <int dim>
class AuditedSolids {
 public:
  virtual ~AuditedSolids() = default;
  /// Total of the external impulses (gravity, loads) inside `explicit_momentum`. Global.
  virtual Momentum<dim> external_impulse(double time, double dt) const = 0;
  /// Linear and angular momentum (about the origin) of each solid for a generalized momentum q on
  /// dof_map; zero for prescribed ones. Every rank gets all. Collective.
  virtual std::vector<Momentum<dim>> momentum_of_each(const Vector& generalized_momentum) const = 0;
  /// Angular momentum about the origin that the inner forces of `explicit_momentum` give at the
  /// present positions [kg m^2/s]: zero but for laws that do not turn with the body, and forces
  /// taken elsewhere on its path. Asked for before `set_velocity`. Global, collective.
  virtual AngularVector<dim> inner_angular_impulse(double) const {
    return AngularVector<dim>::Zero();
  }
  /// Returns the works of the solids' forces in S2, over dt from `time`, which found `velocity`, on
  /// bodies that move at `mean`; called before `set_velocity`. Default, for models without other
  /// forces than loads: nothing. Global, collective.
  virtual std::optional<SolidWork> solid_work(double /*time*/, double /*dt*/,
                                              const Vector& /*velocity*/,
                                              const Vector& /*mean*/) const {
    return {};
  }
};

/// An energy with the round-off that its computation carries [J].
struct ComputedEnergy {
  double value = 0, round_off = 0;
};

/// Nonlinear implicit forces: forces at the positions that the solve leads to.
template <int dim>
class NonlinearSolids {
 public:
  virtual ~NonlinearSolids() = default;
  /// A Newton iteration: linearises forces and D at the positions that this velocity reaches in dt,
  /// instead of at the present ones, until `move` or `set_velocity`. Collective.
  virtual void linearise(double dt, const Vector& velocity) = 0;
  /// The velocity about which forces and D are linearised at present; null: zero. Local.
  virtual RCP<const Vector> linearisation() const = 0;
  /// Returns for each solid the potential of these forces [J] at the velocity V of the solve over
  /// dt, less the quadratic model whose gradient `explicit_momentum` and D are, up to a constant.
  /// Global, collective.
  virtual std::vector<ComputedEnergy> nonlinear_energies(double dt,
                                                         const Vector& velocity) const = 0;
};

/// A rigid solid as joints see it. Its generalized vectors have dim translations of the reference
/// point, then the rotations, in axes of space.
template <int dim>
struct RigidFrame {
  static constexpr int n = dim + n_rotations<dim>;
  Point<dim> position = Point<dim>::Zero();  ///< position of the reference point [m]
  Orientation<dim> orientation = rotation_of<dim>(AngularVector<dim>::Zero());
  Eigen::Matrix<double, n, 1> velocity = Eigen::Matrix<double, n, 1>::Zero();
  Eigen::Matrix<double, n, n> mass = Eigen::Matrix<double, n, n>::Zero();  ///< 0 if prescribed
};

/// Solids that joints can connect, by their numbers in the model. Local, the same on all ranks.
template <int dim>
class JointableSolids {
 public:
  virtual ~JointableSolids() = default;
  virtual RigidFrame<dim> rigid_frame(int solid) const = 0;  ///< at present
  /// Returns the frame of a prescribed solid at a time.
  virtual RigidFrame<dim> prescribed_frame(int solid, double time) const = 0;
  /// Returns the first dof of the solid, in `dof_map`; no_index if it is prescribed.
  virtual GlobalIndex first_dof(int solid) const = 0;
  /// Returns a parameter of this solid that excludes joints; empty: there is none.
  virtual std::string unjointable(int solid) const = 0;
};

/// A line after a step, for lines.csv.
struct LineState {
  std::string name;
  double span = 0;                  ///< distance of its ends [m]
  std::array<double, 2> tension{};  ///< at its ends [N]; negative: it pushes
};

/// Frames and figures that only pictures and tables show.
template <int dim>
class SolidOutput {
 public:
  virtual ~SolidOutput() = default;
  /// Appends meshes with fields beyond the surface, for frames: what is inside, stress and strain.
  /// Collective.
  virtual void add_frames(std::vector<SurfaceFrame>& frames) const = 0;
  /// Returns the present state of each line, the same on all ranks. Local. Default: there are none.
  virtual std::vector<LineState> line_states() const { return {}; }
  /// Elements whose implicit forces were changed to keep C definite, in the last step that used
  /// them; for the history. Global, local call.
  virtual GlobalIndex n_clamped_elements() const { return 0; }
  /// Largest stretch beyond its limit that the last `limit_motion` left [1].
  virtual double stretch_beyond_limit() const { return 0; }
};

}  // namespace lockstep
