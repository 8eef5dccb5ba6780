#pragma once
#include <memory>
#include <string>

#include "linear/near_null_space.hpp"

namespace lockstep {

/// C^-1 to round-off for a symmetric positive definite C: direct where that is cheap (see
/// inverse_by_cost.hpp), conjugate gradients to 1e-14 else. `name` is for messages. Throws
/// SolveError if C is not positive definite. Collective, and so is every application.
RCP<const LinearOperator> exact_inverse(const RCP<const LinearOperator>& op,
                                        const std::string& name);

struct InnerSolve {
  RCP<const LinearOperator> preconditioner;  ///< symmetric positive definite; null: none
  RCP<const LinearOperator> rounded;  ///< `op` in less precision, to iterate with; null: itself
  double tolerance = 1e-10;           ///< relative residual
  int maximum_iterations = 1000;
  std::string name;                  ///< for messages
  std::shared_ptr<long> iterations;  ///< counted here, if given
};
/// The inverse by conjugate gradients. Applying it throws SolveError if the tolerance is not
/// reached. Collective, and so is every application.
RCP<const LinearOperator> conjugate_gradient_inverse(const RCP<const LinearOperator>& op,
                                                     const InnerSolve& inner);
/// Inverse by conjugate gradients with the diagonal as preconditioner (none for a matrix-free
/// operator).
RCP<const LinearOperator> conjugate_gradient_inverse(const RCP<const LinearOperator>& op,
                                                     double tolerance, int maximum_iterations,
                                                     const std::string& name);

}  // namespace lockstep
