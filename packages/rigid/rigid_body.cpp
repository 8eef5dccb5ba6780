#include "rigid/rigid_body.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <optional>

#include "base/round_off.hpp"
#include "motion/free_rotation.hpp"

namespace lockstep {

namespace {

/// m (|c|^2 1 - c c^T), in 2D m |c|^2.
template <int dim>
Inertia<dim> inertia_of_offset(double mass, const Point<dim>& c) {
  if constexpr (dim == 2) {
    return Inertia<2>(mass * c.squaredNorm());
  } else {
    return mass * (c.squaredNorm() * Inertia<3>::Identity() - c * c.transpose());
  }
}

/// True if the mass matrix is the same in every orientation.
template <int dim>
bool turns_without_effect(const RigidBody<dim>& body) {
  if (!body.center_of_mass.isZero(0))
    return false;
  const double mean = body.inertia.trace() / n_rotations<dim>;
  return (body.inertia - mean * Inertia<dim>::Identity()).norm() <= rounding::sums * mean;
}

}  // namespace

template <int dim>
Inertia<dim> world_inertia(const RigidBody<dim>& body, const Orientation<dim>& orientation) {
  if constexpr (dim == 2) {
    return body.inertia;
  } else {
    const Eigen::Matrix3d rotation = orientation.toRotationMatrix();
    const Inertia<3> inertia = rotation * body.inertia * rotation.transpose();
    return 0.5 * (inertia + inertia.transpose());  // symmetric without round-off
  }
}

template <int dim>
RigidMatrix<dim> mass_matrix(const RigidBody<dim>& body, const Orientation<dim>& orientation) {
  constexpr int n_turns = n_rotations<dim>;
  const Point<dim> c = body.arm(orientation);
  RigidMatrix<dim> mass = RigidMatrix<dim>::Zero();
  mass.template topLeftCorner<dim, dim>().diagonal().setConstant(body.mass);
  mass.template bottomRightCorner<n_turns, n_turns>() =
      world_inertia(body, orientation) + inertia_of_offset<dim>(body.mass, c);
  for (int a = 0; a < dim; ++a) {
    const AngularVector<dim> torque = cross<dim>(c, body.mass * Point<dim>::Unit(a));
    mass.template block<n_turns, 1>(dim, a) = torque;
    mass.template block<1, n_turns>(a, dim) = torque.transpose();
  }
  return mass;
}

template <int dim>
RigidVector<dim> velocity_of(const RigidBody<dim>& body, const Orientation<dim>& orientation,
                             const RigidVector<dim>& momentum) {
  RigidMatrix<dim> mass = mass_matrix(body, orientation);
  RigidVector<dim> rhs = momentum;
  for (int k = 0; k < n_rigid_dofs<dim>; ++k) {
    if (!body.locked[k])
      continue;
    mass.row(k).setZero();
    mass.col(k).setZero();
    mass(k, k) = 1;
    rhs[k] = 0;
  }
  return mass.ldlt().solve(rhs);
}

template <int dim>
RigidVector<dim> carried_momentum(const RigidBody<dim>& body, RigidVector<dim> momentum,
                                  const Orientation<dim>& before, const Orientation<dim>& after,
                                  double dt) {
  if (body.center_of_mass.isZero(0) || dt == 0)
    return momentum;
  const Point<dim> swing = body.arm(after) - body.arm(before);
  Point<dim> of_reference = momentum.template head<dim>() - body.mass / dt * swing;
  for (int a = 0; a < dim; ++a) {
    if (body.locked[a])
      of_reference[a] = 0;
  }
  momentum.template tail<n_rotations<dim>>() += cross<dim>(swing, of_reference);
  return momentum;
}

namespace {

template <int dim>
bool all_locked(const RigidBody<dim>& body, int begin, int end) {
  return std::all_of(body.locked.begin() + begin, body.locked.begin() + end,
                     [](bool lock) { return lock; });
}
template <int dim>
bool none_locked(const RigidBody<dim>& body, int begin, int end) {
  return std::none_of(body.locked.begin() + begin, body.locked.begin() + end,
                      [](bool lock) { return lock; });
}

/// Mean velocity of the exact motion over dt, with that momentum at its begin, of a body that
/// nothing holds, or nothing but its pivot. Otherwise nothing.
template <int dim>
std::optional<RigidVector<dim>> free_velocity(const RigidBody<dim>& body,
                                              const RigidVector<dim>& momentum, double dt) {
  constexpr int n_turns = n_rotations<dim>;
  const Orientation<dim>& now = body.pose.orientation;
  const bool held = all_locked(body, 0, dim);
  if (!none_locked(body, dim, n_rigid_dofs<dim>) || (!held && !none_locked(body, 0, dim)))
    return std::nullopt;
  const Point<dim> arm = body.arm(now);
  Inertia<dim> inertia = world_inertia(body, now);
  AngularVector<dim> angular = momentum.template tail<n_turns>();
  RigidVector<dim> velocity = RigidVector<dim>::Zero();
  if (held) {
    inertia += inertia_of_offset<dim>(body.mass, arm);
  } else {
    const Point<dim> linear = momentum.template head<dim>();
    angular -= cross<dim>(arm, linear);
    velocity.template head<dim>() = linear / body.mass;
  }
  const AngularVector<dim> turn = free_turn<dim>(inertia, angular, dt);
  velocity.template tail<n_turns>() = turn / dt;
  if (!held)
    velocity.template head<dim>() -= (body.arm(turned<dim>(turn, now)) - arm) / dt;
  return velocity;
}

/// Likewise whatever holds it: velocity at the middle of the motion, U = M(x^{n+1/2})^-1 (carried
/// momentum), the orientation of x^{n+1/2} being exp(dt/2 omega) times the present one. Nothing if
/// that equation has no solution in reach (turns of the order of a radian).
template <int dim>
std::optional<RigidVector<dim>> middle_velocity(const RigidBody<dim>& body,
                                                const RigidVector<dim>& momentum, double dt) {
  constexpr int n_turns = n_rotations<dim>;
  constexpr int max_iterations = 50;
  const Orientation<dim>& now = body.pose.orientation;
  RigidVector<dim> velocity = velocity_of(body, now, momentum);
  for (int iteration = 0; iteration < max_iterations; ++iteration) {
    const AngularVector<dim> turn = dt / 2 * velocity.template tail<n_turns>();
    const Orientation<dim> middle = turned<dim>(turn, now);
    const RigidVector<dim> next =
        velocity_of(body, middle, carried_momentum(body, momentum, now, middle, dt / 2));
    const double change = dt / 2 * (next - velocity).template tail<n_turns>().norm();
    velocity = next;
    if (change <= rounding::few * std::max(1.0, turn.norm()))
      return velocity;
  }
  return std::nullopt;
}

}  // namespace

template <int dim>
RigidVector<dim> midpoint_correction(const RigidBody<dim>& body, const RigidVector<dim>& momentum,
                                     double half_step) {
  if (turns_without_effect(body) || half_step == 0)
    return RigidVector<dim>::Zero();
  auto velocity = free_velocity(body, momentum, 2 * half_step);
  if (!velocity)
    velocity = middle_velocity(body, momentum, 2 * half_step);
  if (!velocity)
    return RigidVector<dim>::Zero();
  RigidVector<dim> correction = mass_matrix(body, body.pose.orientation) * *velocity - momentum;
  for (int k = 0; k < n_rigid_dofs<dim>; ++k) {
    if (body.locked[k])
      correction[k] = 0;
  }
  return correction;
}

template <int dim>
void follow_script(RigidBody<dim>& body, double time) {
  const ScriptedMotion<dim> motion = body.script(time);
  body.pose.position = body.initial_pose.position + motion.displacement;
  body.pose.orientation = turned<dim>(motion.turn, body.initial_pose.orientation);
  body.velocity << motion.velocity, motion.angular_velocity;
}

template <int dim>
void move(RigidBody<dim>& body, const RigidVector<dim>& velocity, double time, double dt) {
  const RigidPose<dim>& before = body.pose_before = body.pose;
  Point<dim> displacement;
  AngularVector<dim> turn;
  if (body.dynamic()) {
    displacement = dt * velocity.template head<dim>();
    turn = dt * velocity.template tail<n_rotations<dim>>();
    body.pose.position += displacement;
    body.pose.orientation = turned<dim>(turn, before.orientation);
    body.momentum =
        carried_momentum(body, body.momentum, before.orientation, body.pose.orientation, dt);
  } else {
    follow_script(body, time + dt);
    displacement = body.pose.position - before.position;
    turn = rotation_vector<dim>(body.pose.orientation * before.orientation.inverse());
  }
  body.last_move = twist_of<dim>(before.position, displacement, turn, dt);
}

template <int dim>
void set_velocity(RigidBody<dim>& body, const RigidVector<dim>& velocity) {
  body.velocity = velocity;
  body.momentum = mass_matrix(body, body.pose.orientation) * velocity;
}

template <int dim>
double kinetic_energy(const RigidBody<dim>& body) {
  const AngularVector<dim> omega = body.angular_velocity();
  return 0.5 * body.mass * body.velocity_of_center().squaredNorm() +
         0.5 * omega.dot(world_inertia(body, body.pose.orientation) * omega);
}

template Inertia<2> world_inertia<2>(const RigidBody<2>&, const Orientation<2>&);
template RigidMatrix<2> mass_matrix<2>(const RigidBody<2>&, const Orientation<2>&);
template RigidVector<2> velocity_of<2>(const RigidBody<2>&, const Orientation<2>&,
                                       const RigidVector<2>&);
template RigidVector<2> carried_momentum<2>(const RigidBody<2>&, RigidVector<2>,
                                            const Orientation<2>&, const Orientation<2>&, double);
template RigidVector<2> midpoint_correction<2>(const RigidBody<2>&, const RigidVector<2>&, double);
template void move<2>(RigidBody<2>&, const RigidVector<2>&, double, double);
template void follow_script<2>(RigidBody<2>&, double);
template void set_velocity<2>(RigidBody<2>&, const RigidVector<2>&);
template double kinetic_energy<2>(const RigidBody<2>&);
template Inertia<3> world_inertia<3>(const RigidBody<3>&, const Orientation<3>&);
template RigidMatrix<3> mass_matrix<3>(const RigidBody<3>&, const Orientation<3>&);
template RigidVector<3> velocity_of<3>(const RigidBody<3>&, const Orientation<3>&,
                                       const RigidVector<3>&);
template RigidVector<3> carried_momentum<3>(const RigidBody<3>&, RigidVector<3>,
                                            const Orientation<3>&, const Orientation<3>&, double);
template RigidVector<3> midpoint_correction<3>(const RigidBody<3>&, const RigidVector<3>&, double);
template void move<3>(RigidBody<3>&, const RigidVector<3>&, double, double);
template void follow_script<3>(RigidBody<3>&, double);
template void set_velocity<3>(RigidBody<3>&, const RigidVector<3>&);
template double kinetic_energy<3>(const RigidBody<3>&);

}  // namespace lockstep
