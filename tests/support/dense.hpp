#pragma once
#include <Eigen/Core>

#include "linear/types.hpp"

namespace lockstep::test {

/// A distributed vector by global id, on every rank; ids must be 0 .. n-1. Collective.
Eigen::VectorXd dense(const Vector& vector);

/// A small operator on every rank; column by column if it is matrix-free. Collective.
Eigen::MatrixXd dense(const RCP<const LinearOperator>& op);
Eigen::MatrixXd dense(const RCP<const CrsMatrix>& matrix);

/// The vector of these values on a map whose ids are 0 .. n-1.
RCP<Vector> distributed(const Eigen::VectorXd& values, const RCP<const Map>& map);

}  // namespace lockstep::test
