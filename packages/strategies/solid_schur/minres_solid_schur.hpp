#pragma once
#include "strategies/common/minres_strategy.hpp"

namespace lockstep {

/// `solid-schur`: MINRES on Eq. 16 with the preconditioner diag(M, (C + B^T M B)^-1), M an
/// approximate inverse of A. For a few rigid bodies: each solid unknown takes one application of M,
/// whenever the geometry changes. A fluid region that a dynamic body closes makes A singular and
/// the Schur complement of M meaningless there: such systems are refused.
class MinresSolidSchur : public MinresStrategy {
 public:
  explicit MinresSolidSchur(const ParameterList& list);
  static ParameterList valid_parameters();
  std::string name() const override { return "solid-schur"; }

 private:
  Preconditioners make_preconditioners(const BlockSystem& system) override;

  int largest_solid_;
};

}  // namespace lockstep
