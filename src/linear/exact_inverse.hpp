#pragma once
#include <string>

#include "linear/types.hpp"

namespace lockstep {

/// C^-1 to round-off for a symmetric positive definite C, by the cheapest way that is exact: dense
/// blocks if C falls apart into blocks of at most 24 rows, a gathered direct solve up to 20 000
/// rows, conjugate gradients to 1e-14 beyond that and for a matrix-free C. `name` is for messages.
/// Throws SolveError if C is not positive definite. Collective, and so is every application.
RCP<const LinearOperator> exact_inverse(const RCP<const LinearOperator>& op,
                                        const std::string& name);

/// The inverse by conjugate gradients with the diagonal as preconditioner (none for a matrix-free
/// operator), to the relative residual `tolerance`. Applying it throws SolveError if that is not
/// reached in `maximum_iterations`. Collective, and so is every application.
RCP<const LinearOperator> conjugate_gradient_inverse(const RCP<const LinearOperator>& op,
                                                     double tolerance, int maximum_iterations,
                                                     const std::string& name);

}  // namespace lockstep
