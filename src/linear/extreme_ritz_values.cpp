#include "linear/extreme_ritz_values.hpp"

#include <Eigen/Eigenvalues>
#include <Tpetra_Vector.hpp>
#include <cmath>

#include "linear/null_space.hpp"
#include "linear/symmetry_check.hpp"

namespace lockstep {

RitzValues extreme_ritz_values(const Action& op, const Action& preconditioner,
                               const RCP<const Map>& map, const NullSpace& null_space,
                               int n_steps) {
  Vector r(map), z(map), d(map), q(map), seed(map);
  pseudo_random(seed, 1);
  op(seed, r);  // in the range of K, also where K has empty rows
  // The tridiagonal Lanczos matrix from the coefficients of conjugate gradients (Golub and Van
  // Loan, section 10.2.5).
  std::vector<double> diagonal, below;
  double r_dot_z = 0, first = 0, previous_step = 1;
  for (int i = 0; i < n_steps; ++i) {
    preconditioner(r, z);
    project_out(null_space, z);
    const double previous = r_dot_z;
    r_dot_z = r.dot(z);
    if (i == 0)
      first = r_dot_z;
    if (!(r_dot_z > 1e-24 * first))
      break;
    const double beta = i == 0 ? 0 : r_dot_z / previous;
    d.update(1, z, beta);
    op(d, q);
    const double step = r_dot_z / d.dot(q);
    diagonal.push_back(1 / step + (i == 0 ? 0 : beta / previous_step));
    if (i > 0)
      below.push_back(std::sqrt(beta) / previous_step);
    r.update(-step, q, 1);
    previous_step = step;
  }
  if (diagonal.empty())
    return {1, 1};
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen;
  eigen.computeFromTridiagonal(
      Eigen::Map<const Eigen::VectorXd>(diagonal.data(), static_cast<long>(diagonal.size())),
      Eigen::Map<const Eigen::VectorXd>(below.data(), static_cast<long>(below.size())),
      Eigen::EigenvaluesOnly);
  return {eigen.eigenvalues().minCoeff(), eigen.eigenvalues().maxCoeff()};
}

}  // namespace lockstep
