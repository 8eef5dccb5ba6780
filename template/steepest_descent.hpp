#pragma once
#include "strategies/common/refined_strategy.hpp"
#include "strategies/common/strategy_parameters.hpp"

namespace lockstep {

/// A solver strategy of your own: preconditioned steepest descent on the
/// Schur complement S = A + B C^-1 B^T, with the relaxation that minimises the error's energy.
class SteepestDescent : public RefinedStrategy {
 public:
  explicit SteepestDescent(const ParameterList& list);
  static ParameterList valid_parameters();
  std::string name() const override { return "steepest-descent"; }

 private:
  void build(const BlockSystem& system, bool geometry_changed, bool solid_changed) override;
  int correct(const BlockSystem& system, const CorrectionRequest& request,
              Vector& correction) override;

  double shortening_;
};

}  // namespace lockstep
