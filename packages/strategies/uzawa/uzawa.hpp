#pragma once
#include "strategies/common/refined_strategy.hpp"
#include "strategies/common/strategy_parameters.hpp"

namespace lockstep {

/// The partitioned iteration, kept as a control: solve the fluid with the solid's velocity given,
/// then the solid with that pressure, and so on, with relaxation. In terms of pressures it is
/// Richardson's iteration p̂ += omega A^-1 (r - S p̂) on S = A + B C^-1 B^T: it converges only while
/// omega < 2 / (1 + added mass / solid mass), and slowly near that; divergence is reported with the
/// largest relaxation that its growth allows. A region that a dynamic body closes leaves the fluid
/// alone without solution: refused.
class Uzawa : public RefinedStrategy {
 public:
  explicit Uzawa(const ParameterList& list);
  static ParameterList valid_parameters();
  std::string name() const override { return "uzawa"; }

 private:
  void build(const BlockSystem& system, bool geometry_changed, bool solid_changed) override;
  int correct(const BlockSystem& system, const CorrectionRequest& request,
              Vector& correction) override;

  double relaxation_, inner_tolerance_;
};

}  // namespace lockstep
