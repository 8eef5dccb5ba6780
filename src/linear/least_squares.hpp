#pragma once
#include <Eigen/Core>

namespace lockstep {

/// Dense, of small systems: Eigen's decomposition takes longer to compile than all else in a file.

/// Returns the shortest of all x that minimise |a x - b|. Pivots below `dependent` of the largest
/// count as zero; 0: below round-off. Local.
Eigen::VectorXd least_squares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b,
                              double dependent = 0);
/// The matrix that takes b to that x. Local.
Eigen::MatrixXd pseudo_inverse(const Eigen::MatrixXd& a);

}  // namespace lockstep
