#pragma once
#include <functional>
#include <string>
#include <vector>

#include "linear/types.hpp"

namespace lockstep {

/// y = (operator) x. Collective.
using Action = std::function<void(const Vector& x, Vector& y)>;

struct ConjugateGradientsRequest {
  std::string name;   ///< for messages
  double target = 0;  ///< stop when the recurrence residual's 2-norm is at most this
  int maximum_iterations = 0;
  /// Null vectors of the operator, orthonormal: kept out of every preconditioned residual.
  std::vector<RCP<const Vector>> null_space;
  /// Asked when the target is reached: the target for this x, if it depends on x. The iteration
  /// goes on if the new one is not reached yet. Collective.
  std::function<double(const Vector& x)> update_target = {};
};

/// Preconditioned conjugate gradients on a symmetric positive (semi)definite operator, from a zero
/// initial guess (pass the residual of a better one as right-hand side, and add the result to it).
/// Returns the number of iterations; running out of them is no error here, for the caller checks
/// the true residual. Throws SolveError if the operator or the preconditioner turns out indefinite
/// or not finite. Right on ranks that own no row. Collective.
int conjugate_gradients(const Action& op, const Action& preconditioner, const Vector& rhs,
                        Vector& x, const ConjugateGradientsRequest& request);

}  // namespace lockstep
