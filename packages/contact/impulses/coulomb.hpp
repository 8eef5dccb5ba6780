#pragma once
#include "base/types.hpp"

namespace lockstep {

/// One contact with Coulomb friction while all others stay. Vectors have the normal part first and
/// the tangential ones behind it.
template <int dim>
struct CoulombContact {
  using Matrix = Eigen::Matrix<double, dim, dim>;
  Matrix mobility = Matrix::Zero();  ///< W: velocity per impulse, positive definite [1/kg]
  Matrix inverse = Matrix::Zero();   ///< W^-1 [kg]
  double friction = 0;               ///< mu, Coulomb's coefficient, above 0 [1]
};

/// Returns the impulse l [kg m/s] after which w = v + W l meets Coulomb's law:
/// 0 <= l_n, 0 <= w_n, l_n w_n = 0, |l_t| <= mu l_n, and where w_t is not zero l_t = -mu l_n times
/// its direction. Of several directions of slip it is the one nearest to that of `last`. `v`: the
/// velocity without the impulse, less what the normal one is to reach [m/s]. Exact, because half
/// steps, normal and then tangential, need thousands of sweeps where W mixes the two (Acary &
/// Brogliato 2008, section 13.7). Local.
template <int dim>
Point<dim> coulomb_impulse(const CoulombContact<dim>& contact, const Point<dim>& v,
                           const Point<dim>& last);

}  // namespace lockstep
