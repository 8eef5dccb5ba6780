#pragma once
#include "linear/types.hpp"

namespace lockstep {

/// The inverse of a square regular matrix: gathered on rank 0 and factored there by KLU2, because
/// the distributed KLU2 of Trilinos 13.2 gives wrong answers. Row ids must be 0 .. n-1 in any
/// distribution. `name` is for messages. Throws SolveError if the matrix is singular. Collective,
/// and so is every application.
RCP<const LinearOperator> gathered_direct(const RCP<const CrsMatrix>& matrix,
                                          const std::string& name);

}  // namespace lockstep
