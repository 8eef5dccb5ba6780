#pragma once
#include "strategies/common/block_krylov.hpp"
#include "strategies/common/refined_strategy.hpp"

namespace lockstep {

/// MINRES on Eq. 16 with the preconditioner diag(pressure, solid), each symmetric positive
/// definite. What the three strategies of this kind share.
class MinresStrategy : public RefinedStrategy {
 protected:
  struct Preconditioners {
    RCP<const LinearOperator> pressure, solid;
  };

  MinresStrategy(const ParameterList& list, const ParameterList& pressure_list);
  /// common_strategy_parameters and "Krylov Method".
  static ParameterList minres_parameters(const std::string& standard_method);

  /// For a system with solids, whenever A, B or C changed. Collective.
  virtual Preconditioners make_preconditioners(const BlockSystem& system) = 0;

 private:
  void build(const BlockSystem& system, bool geometry_changed, bool solid_changed) final;
  int correct(const BlockSystem& system, const CorrectionRequest& request,
              Vector& correction) final;

  MinresKind minres_;
  Preconditioners preconditioners_;
};

}  // namespace lockstep
