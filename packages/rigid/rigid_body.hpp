#pragma once
#include <array>
#include <functional>
#include <string>

#include "geometry/surface_mesh.hpp"
#include "motion/motion_script.hpp"
#include "motion/rotation.hpp"

namespace lockstep {

/// Degrees of freedom of a rigid body: translations of its reference point, then rotations.
template <int dim>
constexpr int n_rigid_dofs = dim + n_rotations<dim>;

/// Generalized velocity (V, omega) or momentum (linear, angular about the reference point), in
/// world axes.
template <int dim>
using RigidVector = Eigen::Matrix<double, n_rigid_dofs<dim>, 1>;
template <int dim>
using RigidMatrix = Eigen::Matrix<double, n_rigid_dofs<dim>, n_rigid_dofs<dim>>;
template <int dim>
using Inertia = Eigen::Matrix<double, n_rotations<dim>, n_rotations<dim>>;

template <int dim>
struct RigidPose {
  Point<dim> position = Point<dim>::Zero();  ///< position of the reference point [m]
  Orientation<dim> orientation = rotation_of<dim>(AngularVector<dim>::Zero());
};

/// A push besides gravity, in axes of space.
template <int dim>
struct Load {
  Point<dim> force = Point<dim>::Zero();                   ///< at the centre of mass [N]
  AngularVector<dim> torque = AngularVector<dim>::Zero();  ///< [N m]
};

/// A load by time [s] and place of the centre of mass [m]. Empty: there is none.
template <int dim>
using LoadLaw = std::function<Load<dim>(double time, const Point<dim>& center)>;

/// Properties of a body that never change. Its coordinates have their origin at the reference
/// point: the centre of mass, or the pivot.
template <int dim>
struct RigidBodyConstants {
  std::string name;
  SurfaceMesh<dim> surface;
  bool closed = true;
  bool seen_by_fluid = true;  ///< false: neither by contact; its surface is in nothing
  double density = 0;         ///< mean [kg/m^dim], of a shell [kg/m^(dim-1)]
  double mass = 0;            ///< [kg]
  double volume = 0;          ///< [m^dim]; 0 for shells
  Point<dim> center_of_mass = Point<dim>::Zero();  ///< in body coordinates [m]
  Inertia<dim> inertia = Inertia<dim>::Zero();     ///< about it, in body axes [kg m^2]
  std::array<bool, n_rigid_dofs<dim>> locked{};    ///< dofs held at zero, in world axes
  LoadLaw<dim> load;
  double restitution = 0, friction = 0;
  MotionScript<dim> script;     ///< empty: dynamic
  RigidPose<dim> initial_pose;  ///< initial pose of the script
};

/// One rigid body.
template <int dim>
struct RigidBody : RigidBodyConstants<dim> {
  RigidPose<dim> pose;
  RigidVector<dim> velocity = RigidVector<dim>::Zero();
  RigidVector<dim> momentum = RigidVector<dim>::Zero();  ///< momentum of a dynamic body
  Twist<dim> last_move;                                  ///< twist of the last `move`
  RigidPose<dim> pose_before;                            ///< the last `move`

  bool dynamic() const { return !this->script; }
  /// From the reference point to the centre of mass, in world axes [m].
  Point<dim> arm() const { return arm(pose.orientation); }
  Point<dim> arm(const Orientation<dim>& orientation) const {
    return orientation * this->center_of_mass;
  }
  Point<dim> center() const { return pose.position + arm(); }  ///< present centre of mass [m]
  Point<dim> linear_velocity() const { return velocity.template head<dim>(); }
  AngularVector<dim> angular_velocity() const { return velocity.template tail<n_rotations<dim>>(); }
  Point<dim> velocity_of_center() const {
    return linear_velocity() + rotate<dim>(angular_velocity(), arm());
  }
  Point<dim> velocity_at(const Point<dim>& x) const {
    return linear_velocity() + rotate<dim>(angular_velocity(), x - pose.position);
  }
};

/// Inertia about the centre of mass in world axes [kg m^2].
template <int dim>
Inertia<dim> world_inertia(const RigidBody<dim>& body, const Orientation<dim>& orientation);

/// M_S of one body with its reference point and orientation: [m, -m [c]; m [c], I_reference]. SPD.
template <int dim>
RigidMatrix<dim> mass_matrix(const RigidBody<dim>& body, const Orientation<dim>& orientation);

/// The velocity of a momentum, with the locked dofs held at zero.
template <int dim>
RigidVector<dim> velocity_of(const RigidBody<dim>& body, const Orientation<dim>& orientation,
                             const RigidVector<dim>& momentum);

/// The momentum about the reference point after a free motion of dt that turned the body: momentum
/// and angular momentum about the centre of mass are conserved, and so is, with the translations
/// locked, angular momentum about the pivot. d L / dt = c' x m V_reference, whose right-hand side
/// is zero without a pivot.
template <int dim>
RigidVector<dim> carried_momentum(const RigidBody<dim>& body, RigidVector<dim> momentum,
                                  const Orientation<dim>& before, const Orientation<dim>& after,
                                  double dt);

/// M(x^n) U - momentum on the free dofs, U the mean velocity over a free motion of 2 half_step that
/// sets out with `momentum`: that of Euler's equations (motion/free_rotation.hpp), so that a body
/// that nothing acts on keeps its energy at any turn. Where a body is held otherwise than at its
/// pivot U is the velocity at the middle, of second order. Exactly zero for bodies whose mass
/// matrix does not turn with them, and if a held body turns by the order of a radian: then the step
/// is of first order.
template <int dim>
RigidVector<dim> midpoint_correction(const RigidBody<dim>& body, const RigidVector<dim>& momentum,
                                     double half_step);

/// Moves a dynamic body with constant generalized velocity, or a prescribed one to its script.
template <int dim>
void move(RigidBody<dim>& body, const RigidVector<dim>& velocity, double time, double dt);

/// Puts a prescribed body where its script has it at `time`.
template <int dim>
void follow_script(RigidBody<dim>& body, double time);

/// V := velocity, and the momentum with it.
template <int dim>
void set_velocity(RigidBody<dim>& body, const RigidVector<dim>& velocity);

/// Kinetic energy of a dynamic body [J].
template <int dim>
double kinetic_energy(const RigidBody<dim>& body);

}  // namespace lockstep
