#pragma once
#include "strategies/common/refined_strategy.hpp"

namespace lockstep {

/// Belos' flexible GMRES on Eq. 16 with a block preconditioner that one of Teko's factories makes,
/// which may be unsymmetric. What the three strategies of this kind share.
class GmresStrategy : public RefinedStrategy {
 protected:
  GmresStrategy(const ParameterList& list, const ParameterList& pressure_list,
                PressureOrder order = PressureOrder::of_the_inverse);
  /// common_strategy_parameters, "Pressure Inverse" and "Restart".
  static ParameterList gmres_parameters();

  /// A preconditioner of `scaled.op`. Collective.
  virtual RCP<const LinearOperator> make_preconditioner(const BlockSystem& system,
                                                        const ScaledSystem& scaled) = 0;

 private:
  void build(const BlockSystem& system, bool geometry_changed, bool solid_changed) final;
  int correct(const BlockSystem& system, const CorrectionRequest& request,
              Vector& correction) final;

  int restart_;
  ScaledSystem scaled_;
};

}  // namespace lockstep
