#pragma once
#include <optional>

#include "strategies/common/refined_strategy.hpp"
#include "strategies/common/strategy_parameters.hpp"

namespace lockstep {

/// Conjugate gradients on Eq. 16 in an inner product of their own (Bramble and Pasciak 1988): with
/// A_0 < A and S_0 near C + B^T A^-1 B, both symmetric positive definite, the operator
/// [A_0, 0; -B^T, -S_0]^-1 [A, -B; -B^T, -C] is symmetric positive definite with respect to
/// H = diag(A - A_0, S_0). A_0 is the approximate inverse of A that the scene names, scaled below A
/// by a Lanczos estimate, and further where that shows to be too high; S_0 is C + B^T A_0^-1 B,
/// dense, for at most "Largest Solid" solid unknowns, else C. A - A_0 cannot be positive where A
/// alone is singular and the system is not: regions closed by a dynamic body are refused.
class BramblePasciak : public RefinedStrategy {
 public:
  explicit BramblePasciak(const ParameterList& list);
  static ParameterList valid_parameters();
  std::string name() const override { return "bramble-pasciak"; }

 private:
  void build(const BlockSystem& system, bool geometry_changed, bool solid_changed) override;
  int correct(const BlockSystem& system, const CorrectionRequest& request,
              Vector& correction) override;
  /// The inverses for an A_0 below A if the smallest eigenvalue of M A is at least this.
  void scale_below(const BlockSystem& system, double smallest);
  /// The iterations taken; nothing if A - A_0 was found not to be positive definite.
  std::optional<int> descend(const BlockSystem& system, const CorrectionRequest& request,
                             Vector& correction);

  int largest_solid_;
  double smallest_ = 1;
  RCP<const LinearOperator> scaled_inverse_;       ///< A_0^-1
  RCP<const LinearOperator> solid_schur_inverse_;  ///< S_0^-1
};

}  // namespace lockstep
