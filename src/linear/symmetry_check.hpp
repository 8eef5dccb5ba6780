#pragma once
#include <string>

#include "linear/types.hpp"

namespace lockstep {

/// |u.Mv - v.Mu| / (|u||Mv|) for two fixed pseudo-random vectors, the same on any number of ranks.
/// About 1e-16 for a symmetric operator. Collective.
double symmetry_defect(const LinearOperator& op);

/// Throws SolveError unless M is symmetric to `tolerance` and v.Mv > 0 for those vectors. MINRES
/// does not notice an unsymmetric preconditioner: it stagnates. `name` is for messages. Collective.
void check_symmetric_positive(const LinearOperator& op, const std::string& name,
                              double tolerance = 1e-8);

/// Fills x with values in [-1, 1] that depend on the row id and `seed` only.
void pseudo_random(Vector& x, int seed);

}  // namespace lockstep
