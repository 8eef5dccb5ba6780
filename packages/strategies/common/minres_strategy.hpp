#pragma once
#include <memory>

#include "strategies/common/belos_method.hpp"
#include "strategies/common/refined_strategy.hpp"

namespace lockstep {

/// Belos' MINRES on Eq. 16 with the preconditioner diag(pressure, solid), each symmetric positive
/// definite. What "paper" and "pressure-schur" share.
class MinresStrategy : public RefinedStrategy {
 protected:
  struct Preconditioners {
    RCP<const LinearOperator> pressure, solid;
  };

  MinresStrategy(const ParameterList& list, const ParameterList& pressure_list);

  /// For a system with solids, whenever A, B or C changed. Collective.
  virtual Preconditioners make_preconditioners(const BlockSystem& system) = 0;

 private:
  void build(const BlockSystem& system, bool geometry_changed, bool solid_changed) final;
  int correct(const BlockSystem& system, const CorrectionRequest& request,
              Vector& correction) final;

  BelosMethod minres_;
  std::unique_ptr<FlatSystem> flat_;
  RCP<const LinearOperator> preconditioner_;  ///< on blocked vectors
};

}  // namespace lockstep
