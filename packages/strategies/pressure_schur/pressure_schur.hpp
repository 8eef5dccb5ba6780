#pragma once
#include "strategies/common/deflation.hpp"
#include "strategies/common/minres_strategy.hpp"

namespace lockstep {

/// MINRES on Eq. 16 with the preconditioner diag(Ŝ^-1, C^-1), where Ŝ approximates the Schur
/// complement S = A + B C^-1 B^T of the solids. With the exact ones the spectrum lies in
/// [-1.618, -1] and [0.618, 1] (Murphy, Golub and Wathen 2000): iterations depend neither on the
/// density nor on h nor dt, and Ŝ is positive definite for closed balloons, where A is not. Ŝ^-1 is
/// - with multigrid: its cycle, with the rigid motions of light solids projected out (Deflation);
/// - with another inverse of A: that, updated by Woodbury's formula for at most "Largest Solid"
///   solid unknowns, else the inverse of the assembled A + B diag(C)^-1 B^T, which is sparse for
///   the nodes of deformable solids.
class PressureSchur : public MinresStrategy {
 public:
  explicit PressureSchur(const ParameterList& list);
  static ParameterList valid_parameters();
  std::string name() const override { return "pressure-schur"; }

 private:
  Preconditioners make_preconditioners(const BlockSystem& system) override;
  RCP<const LinearOperator> schur_inverse(const BlockSystem& system);

  int largest_solid_;
  ParameterList pressure_list_;
  std::unique_ptr<Deflation> deflation_;  ///< null unless some solid is light
};

}  // namespace lockstep
