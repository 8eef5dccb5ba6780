#pragma once
#include "interfaces/solid.hpp"

namespace lockstep {

/// Factors M_i of v(x) = sum_i M_i v_i, the velocity of x if the simplex with these corners carried
/// it along: that of the surface point where x lies on it; beside it the linear motion goes on, and
/// off it the normal turns with the simplex. Every rigid motion of the corners is reproduced, so
/// that an impulse at x, transposed onto the corners, keeps its linear and angular momentum.
template <int dim>
std::array<Eigen::Matrix<double, dim, dim>, dim> carried_point(
    const std::array<Point<dim>, dim>& corners, const SurfacePoint<dim>& point,
    const Point<dim>& x);

}  // namespace lockstep
