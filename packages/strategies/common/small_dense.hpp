#pragma once
#include <Eigen/Dense>

#include "linear/types.hpp"

namespace lockstep {

/// A small square matrix, or vector, whole on every rank; their maps number rows from 0.
/// Collective.
Eigen::MatrixXd replicated(const CrsMatrix& matrix);
Eigen::VectorXd replicated(const Vector& vector);

/// This rank's part of a replicated vector. Local.
void distribute(const Eigen::VectorXd& values, Vector& vector);

}  // namespace lockstep
