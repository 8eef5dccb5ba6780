#include "rigid/rigid_body.hpp"

#include <Eigen/Cholesky>

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

/// Whether the mass matrix is the same in every orientation.
template <int dim>
bool turns_without_effect(const RigidBody<dim>& body) {
  if (!body.center_of_mass.isZero(0))
    return false;
  const double mean = body.inertia.trace() / n_rotations<dim>;
  return (body.inertia - mean * Inertia<dim>::Identity()).norm() <= 1e-12 * mean;
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
RigidVector<dim> carried_momentum(const RigidBody<dim>& body, const Orientation<dim>& before,
                                  const Orientation<dim>& after, double dt) {
  RigidVector<dim> momentum = body.momentum;
  if (body.center_of_mass.isZero(0) || dt == 0)
    return momentum;
  const Point<dim> swing = body.arm(after) - body.arm(before);
  Point<dim> of_reference = body.momentum.template head<dim>() - body.mass / dt * swing;
  for (int a = 0; a < dim; ++a) {
    if (body.locked[a])
      of_reference[a] = 0;
  }
  momentum.template tail<n_rotations<dim>>() += cross<dim>(swing, of_reference);
  return momentum;
}

template <int dim>
RigidVector<dim> midpoint_correction(const RigidBody<dim>& body, double half_step) {
  constexpr int n_turns = n_rotations<dim>;
  constexpr int max_iterations = 50;
  const Orientation<dim>& now = body.pose.orientation;
  if (turns_without_effect(body) || half_step == 0)
    return RigidVector<dim>::Zero();
  RigidVector<dim> velocity = velocity_of(body, now, body.momentum);
  bool converged = false;
  for (int iteration = 0; iteration < max_iterations && !converged; ++iteration) {
    const AngularVector<dim> turn = half_step * velocity.template tail<n_turns>();
    const Orientation<dim> middle = turned<dim>(turn, now);
    const RigidVector<dim> next =
        velocity_of(body, middle, carried_momentum(body, now, middle, half_step));
    const double change = half_step * (next - velocity).template tail<n_turns>().norm();
    converged = change <= 1e-14 * std::max(1.0, turn.norm());
    velocity = next;
  }
  if (!converged)
    return RigidVector<dim>::Zero();
  RigidVector<dim> correction = mass_matrix(body, now) * velocity - body.momentum;
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
    body.momentum = carried_momentum(body, before.orientation, body.pose.orientation, dt);
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
template RigidVector<2> carried_momentum<2>(const RigidBody<2>&, const Orientation<2>&,
                                            const Orientation<2>&, double);
template RigidVector<2> midpoint_correction<2>(const RigidBody<2>&, double);
template void move<2>(RigidBody<2>&, const RigidVector<2>&, double, double);
template void follow_script<2>(RigidBody<2>&, double);
template void set_velocity<2>(RigidBody<2>&, const RigidVector<2>&);
template double kinetic_energy<2>(const RigidBody<2>&);
template Inertia<3> world_inertia<3>(const RigidBody<3>&, const Orientation<3>&);
template RigidMatrix<3> mass_matrix<3>(const RigidBody<3>&, const Orientation<3>&);
template RigidVector<3> velocity_of<3>(const RigidBody<3>&, const Orientation<3>&,
                                       const RigidVector<3>&);
template RigidVector<3> carried_momentum<3>(const RigidBody<3>&, const Orientation<3>&,
                                            const Orientation<3>&, double);
template RigidVector<3> midpoint_correction<3>(const RigidBody<3>&, double);
template void move<3>(RigidBody<3>&, const RigidVector<3>&, double, double);
template void follow_script<3>(RigidBody<3>&, double);
template void set_velocity<3>(RigidBody<3>&, const RigidVector<3>&);
template double kinetic_energy<3>(const RigidBody<3>&);

}  // namespace lockstep
