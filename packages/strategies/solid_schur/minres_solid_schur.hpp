#pragma once
#include "strategies/common/block_krylov.hpp"
#include "strategies/common/refined_strategy.hpp"

namespace lockstep {

/// `solid-schur`: MINRES on Eq. 16 with the preconditioner diag(M, (C + B^T M B)^-1), M an
/// approximate inverse of A. For a few rigid bodies: each solid unknown takes one application of M,
/// whenever the geometry changes. A fluid region that a dynamic body closes makes A singular and
/// the Schur complement of M meaningless there: such systems are refused.
class MinresSolidSchur : public RefinedStrategy {
 public:
  explicit MinresSolidSchur(const ParameterList& list);
  static ParameterList valid_parameters();
  std::string name() const override { return "solid-schur"; }

 private:
  void build(const BlockSystem& system, bool geometry_changed, bool solid_changed) override;
  int correct(const BlockSystem& system, const CorrectionRequest& request,
              Vector& correction) override;

  MinresKind minres_;
  int largest_solid_;
  RCP<const LinearOperator> solid_preconditioner_;
};

}  // namespace lockstep
