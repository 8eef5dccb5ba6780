#pragma once
#include "interfaces/strategy.hpp"

namespace lockstep {

/// Most solid unknowns for which strategies take `woodbury_inverse`: it stores a vector of
/// pressures for each of them, 18 for three rigid bodies in space. With more, multigrid stays that
/// of A, and other inverses are those of A + B diag(C)^-1 B^T.
constexpr int largest_woodbury_rank = 18;

/// (M^-1 + B C^-1 B^T)^-1 = M - M B Ŝ^-1 B^T M (Woodbury) with the dense Ŝ = C + B^T M B, for an
/// approximate inverse M of A that is symmetric positive definite; in a form that is so, too,
/// however light the solids are (after Bucy and Joseph 1968). Ŝ is factored on every rank, M
/// applied and a vector of pressures stored for each solid unknown: for a few rigid bodies. C must
/// be assembled. Throws SolveError if Ŝ is not positive definite. Collective.
RCP<const LinearOperator> woodbury_inverse(const BlockSystem& system,
                                           const RCP<const LinearOperator>& pressure_inverse);

}  // namespace lockstep
