#pragma once
#include "solve/merge.hpp"
#include "strategies/common/refined_strategy.hpp"
#include "strategies/common/strategy_parameters.hpp"

namespace lockstep {

/// The oracle: KLU2 on the merged matrix, gathered on rank 0, with iterative refinement. For tests
/// and small systems; null vectors are bordered. Without a solid block the same on A.
class Direct : public RefinedStrategy {
 public:
  explicit Direct(const ParameterList& list);
  static ParameterList valid_parameters();
  std::string name() const override { return "direct"; }

 private:
  void build(const BlockSystem& system, bool geometry_changed, bool solid_changed) override;
  int correct(const BlockSystem& system, const CorrectionRequest& request,
              Vector& correction) override;

  bool is_built_for(const BlockSystem& system) const override {
    return !factors_[system.has_solid()].inverse.is_null();
  }

  struct Factors {
    MergedSystem merged;
    RCP<const LinearOperator> inverse;
  };
  std::array<Factors, 2> factors_;  ///< without and with the solid block
};

}  // namespace lockstep
