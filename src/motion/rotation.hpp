#pragma once
#include <type_traits>

#include "base/types.hpp"

namespace lockstep {

/// Rotation of a body out of its reference position: an angle in 2D, a unit quaternion in 3D.
template <int dim>
using Orientation =
    std::conditional_t<dim == 2, Eigen::Rotation2D<double>, Eigen::Quaternion<double>>;

/// exp: the rotation about the direction of `vector` by its length [rad].
template <int dim>
Orientation<dim> rotation_of(const AngularVector<dim>& vector);

/// log: the shortest rotation vector [rad], of length at most pi.
template <int dim>
AngularVector<dim> rotation_vector(const Orientation<dim>& orientation);

/// `turn` after `orientation`, of unit length.
template <int dim>
Orientation<dim> turned(const AngularVector<dim>& turn, const Orientation<dim>& orientation);

/// A constant rigid velocity field v(x) = linear + angular x (x - origin).
template <int dim>
struct Twist {
  Point<dim> origin = Point<dim>::Zero();                   ///< [m]
  Point<dim> linear = Point<dim>::Zero();                   ///< velocity at the origin [m/s]
  AngularVector<dim> angular = AngularVector<dim>::Zero();  ///< [rad/s]

  Point<dim> velocity(const Point<dim>& x) const {
    return linear + rotate<dim>(angular, x - origin);
  }
};

/// The twist whose flow over dt [s] turns a body by the rotation vector `turn` [rad] while its
/// point `origin` goes to origin + displacement: log of that rigid motion over dt. Turns of more
/// than half a revolution are replaced by the shorter one with the same end. Zero for dt = 0.
template <int dim>
Twist<dim> twist_of(const Point<dim>& origin, const Point<dim>& displacement,
                    const AngularVector<dim>& turn, double dt);

}  // namespace lockstep
