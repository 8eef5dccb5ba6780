#pragma once
#include "strategies/common/refined_strategy.hpp"
#include "strategies/common/strategy_parameters.hpp"

namespace lockstep {

/// The baseline of Section 6.1: eliminates V_S, assembles the Schur complement A + B C^-1 B^T and
/// solves it by conjugate gradients with incomplete Cholesky. The rows of the cells that a rigid
/// body touches are dense, so that a body in n^3 cells fills O(n^4) entries: for the comparison,
/// and for solids of few cells. C must fall apart into small blocks.
class BlockElimination : public RefinedStrategy {
 public:
  explicit BlockElimination(const ParameterList& list);
  static ParameterList valid_parameters();
  std::string name() const override { return "block-elimination"; }

 private:
  void build(const BlockSystem& system, bool geometry_changed, bool solid_changed) override;
  int correct(const BlockSystem& system, const CorrectionRequest& request,
              Vector& correction) override;
  long stored_nonzeros() const override;

  ParameterList list_;
  RCP<const CrsMatrix> schur_;
  RCP<const LinearOperator> schur_inverse_;
};

}  // namespace lockstep
