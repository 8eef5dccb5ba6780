#include "motion/free_rotation.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace lockstep {

namespace {

constexpr double full_turn = 6.283185307179586;

Eigen::Matrix3d product_with(const Point<3>& vector) {
  Eigen::Matrix3d matrix;
  matrix << 0, -vector.z(), vector.y(), vector.z(), 0, -vector.x(), -vector.y(), vector.x(), 0;
  return matrix;
}

/// A body whose axes are those of space at the begin.
struct Top {
  const Eigen::Matrix3d& inverse_inertia;
  Point<3> momentum;  ///< in the body's axes
  Eigen::Quaterniond orientation;
  Point<3> turn;  ///< the sum of those of its steps

  /// The midpoint rule: momentum m solves m = M + h/2 m x omega(m), omega = I^-1 m, by Newton's
  /// method; then the body turns by the Cayley transform of h omega. Fails if that does not
  /// converge.
  bool advance(double step) {
    constexpr int most_iterations = 30;
    const double size = momentum.norm();
    Point<3> middle = momentum;
    double before = 1e300;
    for (int iteration = 0; iteration < most_iterations; ++iteration) {
      const Point<3> omega = inverse_inertia * middle;
      const Point<3> residual = middle - momentum - 0.5 * step * middle.cross(omega);
      const Eigen::Matrix3d slope =
          Eigen::Matrix3d::Identity() -
          0.5 * step * (product_with(middle) * inverse_inertia - product_with(omega));
      const Point<3> change = slope.inverse() * residual;
      middle -= change;
      const double moved = change.norm();
      if (!(moved < 1e100 * size))
        return false;
      // Changes that get no smaller are round-off.
      if (moved <= 1e-16 * size || (moved <= 1e-9 * size && moved >= 0.5 * before)) {
        turn_by(step * (inverse_inertia * middle));
        return true;
      }
      before = moved;
    }
    return false;
  }

  void turn_by(const Point<3>& way) {
    const Eigen::Quaterniond cayley =
        Eigen::Quaterniond(1, 0.5 * way.x(), 0.5 * way.y(), 0.5 * way.z()).normalized();
    turn += orientation * rotation_vector<3>(cayley);
    orientation = (orientation * cayley).normalized();
    momentum = cayley.inverse() * momentum;
  }
};

/// Turns about a fixed axis if the steps fail.
Point<3> turn_in_steps(const Eigen::Matrix3d& inverse_inertia, const Point<3>& angular_momentum,
                       double dt) {
  constexpr double longest = 0.1;  // rad in one of the steps
  constexpr int most = 4000;
  constexpr double a = 0.784513610477560, b = 0.235573213359357, c = -1.17767998417887;
  constexpr double parts[] = {a, b, c, 1 - 2 * (a + b + c), c, b, a};
  const Point<3> omega = inverse_inertia * angular_momentum;
  // A body of this energy turns nowhere faster than about the axis of its least inertia.
  const double fastest = std::sqrt(omega.dot(angular_momentum) * inverse_inertia.norm());
  if (!std::isfinite(fastest))
    return dt * omega;
  const double n = std::clamp(std::ceil(std::abs(dt) * fastest / longest), 1.0, double(most));
  Top top{inverse_inertia, angular_momentum, Eigen::Quaterniond::Identity(), Point<3>::Zero()};
  for (int step = 0; step < static_cast<int>(n); ++step) {
    for (const double part : parts) {
      if (!top.advance(part * dt / n))
        return dt * omega;
    }
  }
  return nearest_turn<3>(rotation_vector<3>(top.orientation), top.turn);
}

}  // namespace

template <int dim>
AngularVector<dim> nearest_turn(const AngularVector<dim>& turn, const AngularVector<dim>& near) {
  const double angle = turn.norm();
  if (angle == 0)
    return turn;
  const AngularVector<dim> axis = turn / angle;
  const double other = axis.dot(near);
  return (other + std::remainder(angle - other, full_turn)) * axis;
}

template <int dim>
AngularVector<dim> free_turn(const InertiaTensor<dim>& inertia,
                             const AngularVector<dim>& angular_momentum, double dt) {
  const InertiaTensor<dim> inverse = inertia.inverse();
  const AngularVector<dim> straight = dt * (inverse * angular_momentum);
  if constexpr (dim == 2) {
    return straight;
  } else {
    // About a principal axis nothing changes.
    const Point<3> change = straight.cross(angular_momentum);
    if (change.norm() <= 1e-15 * straight.norm() * angular_momentum.norm())
      return straight;
    return turn_in_steps(inverse, angular_momentum, dt);
  }
}

template AngularVector<2> nearest_turn<2>(const AngularVector<2>&, const AngularVector<2>&);
template AngularVector<3> nearest_turn<3>(const AngularVector<3>&, const AngularVector<3>&);
template AngularVector<2> free_turn<2>(const InertiaTensor<2>&, const AngularVector<2>&, double);
template AngularVector<3> free_turn<3>(const InertiaTensor<3>&, const AngularVector<3>&, double);

}  // namespace lockstep
