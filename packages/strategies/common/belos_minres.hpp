#pragma once
#include <string>

#include "interfaces/strategy.hpp"

namespace lockstep {

struct MinresRequest {
  std::string name;   ///< for messages
  double target = 0;  ///< of |r_1|, with |r_2| / solid_scale at most target / pressure_scale
  double pressure_scale = 1, solid_scale = 1;
  int maximum_iterations = 0;
};

/// Belos' MINRES on Eq. 16 with right-hand side (rhs, 0), from a zero guess, preconditioned by
/// diag(pressure_inverse, solid_inverse); writes p̂. Returns the number of iterations. Reduces the
/// residual by 1e9 at most; the caller refines. Throws SolveError on a breakdown. Every rank must
/// own rows of both blocks. Collective.
int belos_minres(const BlockSystem& system, const Vector& rhs, const MinresRequest& request,
                 const RCP<const LinearOperator>& pressure_inverse,
                 const RCP<const LinearOperator>& solid_inverse, Vector& pressure);

}  // namespace lockstep
