#pragma once
#include "motion/rotation.hpp"

namespace lockstep {

/// Inertia of a body about a point [kg m^2].
template <int dim>
using InertiaTensor = Eigen::Matrix<double, n_rotations<dim>, n_rotations<dim>>;

/// The rotation vector [rad] by which a body turns in dt that no torque acts on: Euler's equations.
/// `inertia` and `angular_momentum` about the same point, in the axes of space at the begin. Exact
/// to some 1e-10 of the turn up to 400 rad, beyond which its steps grow; energy is kept to
/// round-off. Of the vectors that turn alike it is the one that counts the whole turns. What is not
/// finite stays so. Source: the midpoint rule on the body's momentum with the Cayley transform,
/// which conserves energy and momentum (Austin, Krishnaprasad & Wang 1993), composed to order 6
/// (Yoshida 1990).
template <int dim>
AngularVector<dim> free_turn(const InertiaTensor<dim>& inertia,
                             const AngularVector<dim>& angular_momentum, double dt);

/// Returns the rotation vector of the same rotation as `turn` that is nearest to `near`.
template <int dim>
AngularVector<dim> nearest_turn(const AngularVector<dim>& turn, const AngularVector<dim>& near);

}  // namespace lockstep
