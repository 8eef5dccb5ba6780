#pragma once
#include "strategies/common/minres_strategy.hpp"

namespace lockstep {

/// MINRES on Eq. 16 with the preconditioner diag(Ŝ^-1, C^-1), where Ŝ approximates the Schur
/// complement S = A + B C^-1 B^T of the solids. With the exact ones the spectrum lies in
/// [-1.618, -1] and [0.618, 1] (Murphy, Golub and Wathen 2000): iterations depend neither on the
/// density nor on h nor dt, and Ŝ is positive definite for closed balloons, where A is not. Ŝ^-1 is
/// - for a few light bodies (`WoodburyLimits`), that of A updated by Woodbury's formula;
/// - else with multigrid: that of A and what flows through soft sheets, a little worse the
///   lighter other solids are;
/// - else with other inverses: that of the assembled A + B diag(C)^-1 B^T, which is sparse for
///   the nodes of deformable solids.
class PressureSchur : public MinresStrategy {
 public:
  explicit PressureSchur(const ParameterList& list);
  static ParameterList valid_parameters();
  std::string name() const override { return "pressure-schur"; }

 private:
  bool inverts_schur() const override { return true; }
  Preconditioners make_preconditioners(const BlockSystem& system) override;
  RCP<const LinearOperator> schur_inverse(const BlockSystem& system);

  ParameterList pressure_list_;
};

}  // namespace lockstep
