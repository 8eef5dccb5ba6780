#pragma once
#include "interfaces/solid.hpp"

namespace lockstep {

/// Factors M_i of v(x) = sum_i M_i v_i, the velocity of x by the linear motion of the simplex with
/// these corners: that of the surface point where x lies on it; beside it the linear motion goes
/// on, and off it the normal turns with the simplex. Every rigid motion of the corners is
/// reproduced.
template <int dim>
std::array<Eigen::Matrix<double, dim, dim>, dim> linear_motion(
    const std::array<Point<dim>, dim>& corners, const SurfacePoint<dim>& point,
    const Point<dim>& x);

/// Factors M_i of the velocity of x if the surface point carries x along as on a rod, which keeps
/// its length: along the rod the velocity is the surface point's own, across it that of
/// `linear_motion`. Every rigid motion of the corners is reproduced, so that an impulse at x,
/// transposed onto the corners, keeps its linear and angular momentum. An impulse along the rod, as
/// that of contact without friction, acts at the surface point itself: whichever simplex a point on
/// an edge is counted to, on the same vertices.
template <int dim>
std::array<Eigen::Matrix<double, dim, dim>, dim> carried_point(
    const std::array<Point<dim>, dim>& corners, const SurfacePoint<dim>& point,
    const Point<dim>& x);

}  // namespace lockstep
