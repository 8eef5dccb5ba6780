#include "motion/rotation.hpp"

#include <cmath>

namespace lockstep {

namespace {
/// (1 - (t/2) cot(t/2)) / t^2 for the angle t in [0, pi].
double inverse_jacobian_factor(double angle) {
  if (angle < 1e-2)
    return 1.0 / 12 + angle * angle / 720;
  const double half = 0.5 * angle;
  return (1 - half * std::cos(half) / std::sin(half)) / (angle * angle);
}
}  // namespace

template <int dim>
Orientation<dim> rotation_of(const AngularVector<dim>& vector) {
  if constexpr (dim == 2) {
    return Orientation<2>(vector(0));
  } else {
    const double angle = vector.norm();
    // sin(angle / 2) / angle, which has no singularity.
    const double factor = angle < 1e-4 ? 0.5 - angle * angle / 48 : std::sin(0.5 * angle) / angle;
    const Point<3> imaginary = factor * vector;
    return Orientation<3>(std::cos(0.5 * angle), imaginary.x(), imaginary.y(), imaginary.z());
  }
}

template <int dim>
AngularVector<dim> rotation_vector(const Orientation<dim>& orientation) {
  if constexpr (dim == 2) {
    return AngularVector<2>(std::remainder(orientation.angle(), 2 * pi));
  } else {
    // q and -q are the same rotation: the one with w >= 0 turns by at most pi.
    const double sine = orientation.vec().norm(), cosine = std::abs(orientation.w());
    const double factor = sine < 1e-8 ? 2 : 2 * std::atan2(sine, cosine) / sine;
    return (orientation.w() < 0 ? -factor : factor) * orientation.vec();
  }
}

template <int dim>
Orientation<dim> turned(const AngularVector<dim>& turn, const Orientation<dim>& orientation) {
  Orientation<dim> result = rotation_of<dim>(turn) * orientation;
  if constexpr (dim == 3)
    result.normalize();
  return result;
}

template <int dim>
Twist<dim> twist_of(const Point<dim>& origin, const Point<dim>& displacement,
                    const AngularVector<dim>& turn, double dt) {
  Twist<dim> twist;
  twist.origin = origin;
  if (dt == 0)
    return twist;
  const double angle = turn.norm();
  const double shortest = std::remainder(angle, 2 * pi);
  const AngularVector<dim> phi = angle > pi ? AngularVector<dim>(turn * (shortest / angle)) : turn;
  // The inverse of the left Jacobian of SE(dim): d - phi x d / 2 + factor phi x (phi x d).
  const Point<dim> across = rotate<dim>(phi, displacement);
  const double factor = inverse_jacobian_factor(phi.norm());
  twist.linear = (displacement - 0.5 * across + factor * rotate<dim>(phi, across)) / dt;
  twist.angular = phi / dt;
  return twist;
}

template Orientation<2> rotation_of<2>(const AngularVector<2>&);
template Orientation<3> rotation_of<3>(const AngularVector<3>&);
template AngularVector<2> rotation_vector<2>(const Orientation<2>&);
template AngularVector<3> rotation_vector<3>(const Orientation<3>&);
template Orientation<2> turned<2>(const AngularVector<2>&, const Orientation<2>&);
template Orientation<3> turned<3>(const AngularVector<3>&, const Orientation<3>&);
template Twist<2> twist_of<2>(const Point<2>&, const Point<2>&, const AngularVector<2>&, double);
template Twist<3> twist_of<3>(const Point<3>&, const Point<3>&, const AngularVector<3>&, double);

}  // namespace lockstep
