#pragma once
#include "strategies/common/refined_strategy.hpp"
#include "strategies/common/strategy_parameters.hpp"

namespace lockstep {

/// Eliminates V_S: conjugate gradients on the Schur complement S = A + B C^-1 B^T, never assembled,
/// preconditioned by an approximate inverse of A, which with multigrid also knows what flows
/// through soft sheets. The fastest of the three while C^-1 is cheap (rigid bodies, small
/// deformables). Right on ranks that own no row of a block.
class SchurCg : public RefinedStrategy {
 public:
  /// `list` as valid_parameters() describes it; what it leaves out takes its default. Throws
  /// InputError for a bad sublist.
  explicit SchurCg(const ParameterList& list);
  static ParameterList valid_parameters();
  std::string name() const override { return "schur-cg"; }

 private:
  bool inverts_schur() const override { return true; }
  bool works_in_stages() const override { return solid().iterates(); }
  int correct(const BlockSystem& system, const CorrectionRequest& request,
              Vector& correction) override;
};

}  // namespace lockstep
