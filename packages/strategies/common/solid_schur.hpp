#pragma once
#include <memory>
#include <string>

#include "interfaces/strategy.hpp"

namespace lockstep {

/// The Schur complement of the pressures, with an approximate inverse M of A in place of A^-1:
/// Ŝ = C + B^T M B, dense, factored on every rank. One application of M for each solid unknown, so
/// for a few rigid bodies only.
class SolidSchur {
 public:
  enum class Keep { nothing, columns };
  /// M must be symmetric positive definite. With Keep::columns M B stays stored, for `woodbury`.
  /// Throws SolveError, naming the strategy `who`, with more than `largest` solid unknowns.
  /// Collective.
  static std::shared_ptr<const SolidSchur> make(const BlockSystem& system,
                                                const RCP<const LinearOperator>& pressure_inverse,
                                                int largest, const std::string& who,
                                                Keep keep = Keep::nothing);
  virtual ~SolidSchur() = default;

  /// Ŝ^-1 as an operator on the solid unknowns.
  virtual RCP<const LinearOperator> inverse() const = 0;
  /// (M^-1 + B C^-1 B^T)^-1 = M - M B Ŝ^-1 B^T M (Woodbury), in a form that is symmetric positive
  /// definite however light the solids are (after Bucy and Joseph 1968).
  virtual RCP<const LinearOperator> woodbury() const = 0;
};

}  // namespace lockstep
