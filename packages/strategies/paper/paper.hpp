#pragma once
#include "strategies/common/refined_strategy.hpp"
#include "strategies/common/strategy_parameters.hpp"

namespace lockstep {

/// Section 6.1: MINRES on Eq. 16 with the preconditioner diag(incomplete Cholesky of A, C^-1).
/// MINRES is Belos', through Thyra's block operator, on the system scaled symmetrically so that
/// both blocks' residuals mean the same. Every rank must own rows of both blocks.
class Paper : public RefinedStrategy {
 public:
  explicit Paper(const ParameterList& list);
  static ParameterList valid_parameters();
  std::string name() const override { return "paper"; }

 private:
  void build(const BlockSystem& system, bool geometry_changed, bool solid_changed) override;
  int correct(const BlockSystem& system, const CorrectionRequest& request,
              Vector& correction) override;

  ParameterList solid_list_;
  RCP<const LinearOperator> solid_preconditioner_;
};

}  // namespace lockstep
