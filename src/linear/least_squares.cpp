#include "linear/least_squares.hpp"

#include <Eigen/QR>

namespace lockstep {

namespace {
using Decomposition = Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>;
}  // namespace

Eigen::VectorXd least_squares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b,
                              double dependent) {
  Decomposition factors(a.rows(), a.cols());
  if (dependent > 0)
    factors.setThreshold(dependent);
  factors.compute(a);
  return factors.solve(b);
}

Eigen::MatrixXd pseudo_inverse(const Eigen::MatrixXd& a) {
  return Decomposition(a).pseudoInverse();
}

}  // namespace lockstep
