#pragma once
#include "strategies/common/minres_strategy.hpp"

namespace lockstep {

/// Section 6.1: MINRES on Eq. 16 with the preconditioner diag(incomplete Cholesky of A, C^-1), C^-1
/// to round-off unless "Solid Inverse" says otherwise.
/// MINRES is Belos' (MinresStrategy). Iterations grow like sqrt(1 + added mass / solid mass) / h.
class Paper : public MinresStrategy {
 public:
  explicit Paper(const ParameterList& list);
  static ParameterList valid_parameters();
  std::string name() const override { return "paper"; }

 private:
  Preconditioners make_preconditioners(const BlockSystem& system) override;
};

}  // namespace lockstep
