#pragma once
#include <functional>

#include "interfaces/strategy.hpp"

namespace lockstep {

/// Strategies take `woodbury_inverse` within these limits. With more or heavier solids multigrid
/// stays that of A, and other inverses are those of A + B diag(C)^-1 B^T.
struct WoodburyLimits {
  /// It stores a vector of pressures for each solid unknown: 18 for three rigid bodies in space.
  int most_unknowns = 18;
  /// Largest eigenvalue of C^-1 B^T M B, the mass that the fluid adds over the solids' own: below,
  /// what the formula saves in iterations is less than it costs, a cycle for each unknown in the
  /// set-up and two passes over all vectors in an iteration.
  double least_added_mass = 1000;
};

/// (M^-1 + B C^-1 B^T)^-1 = M - M B Ŝ^-1 B^T M (Woodbury) with the dense Ŝ = C + B^T M B, for an
/// approximate inverse M of A that is symmetric positive definite; in a form that is so, too,
/// however light the solids are (after Bucy and Joseph 1968). Ŝ is factored on every rank, M
/// applied and a vector of pressures stored for each solid unknown: for a few rigid bodies. C must
/// be assembled. Throws SolveError if Ŝ is not positive definite. Collective.
RCP<const LinearOperator> woodbury_inverse(const BlockSystem& system,
                                           const RCP<const LinearOperator>& pressure_inverse);

/// `woodbury_inverse` within `limits`, of the M that is made only then; null beyond, and where C is
/// not assembled. Estimates the added mass by three steps of the power method, each an application
/// of M. Collective.
RCP<const LinearOperator> woodbury_inverse_within(
    const WoodburyLimits& limits, const BlockSystem& system,
    const std::function<RCP<const LinearOperator>()>& make_pressure_inverse);

}  // namespace lockstep
