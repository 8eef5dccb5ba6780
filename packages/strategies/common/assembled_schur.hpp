#pragma once
#include "interfaces/strategy.hpp"

namespace lockstep {

/// S = A + B C^-1 B^T as a matrix. Dense over the cells that a rigid body touches: O(n^4) entries
/// for a body in n^3 cells (Section 6.1). Throws SolveError unless A is assembled and C falls apart
/// into small blocks. Collective.
RCP<const CrsMatrix> assembled_schur(const BlockSystem& system);

/// Returns A + B diag(C)^-1 B^T as a matrix.
RCP<const CrsMatrix> schur_with_diagonal(const BlockSystem& system);

}  // namespace lockstep
