#pragma once
#include "strategies/common/block_krylov.hpp"
#include "strategies/common/refined_strategy.hpp"

namespace lockstep {

/// Section 6.1: MINRES on Eq. 16 with the preconditioner diag(incomplete Cholesky of A, C^-1).
/// MINRES is Belos', through Thyra's block operator, on the system scaled symmetrically so that
/// both blocks' residuals mean the same; then every rank must own rows of both blocks. Iterations
/// grow like sqrt(1 + added mass / solid mass) / h.
class Paper : public RefinedStrategy {
 public:
  explicit Paper(const ParameterList& list);
  static ParameterList valid_parameters();
  std::string name() const override { return "paper"; }

 private:
  void build(const BlockSystem& system, bool geometry_changed, bool solid_changed) override;
  int correct(const BlockSystem& system, const CorrectionRequest& request,
              Vector& correction) override;

  MinresKind minres_;
  ParameterList solid_list_;
  RCP<const LinearOperator> solid_preconditioner_;
};

}  // namespace lockstep
