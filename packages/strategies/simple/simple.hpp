#pragma once
#include "strategies/common/gmres_strategy.hpp"

namespace lockstep {

/// Flexible GMRES with Teko's SIMPLE (Patankar 1980), Eq. 16 read as a Stokes problem whose first
/// block is A: the Schur complement of the solids is C + B^T diag(A)^-1 B, assembled, and inverted
/// exactly. diag(A) knows the pressure of one cell only, so that iterations grow with the solid's
/// size in cells where it is light.
class Simple : public GmresStrategy {
 public:
  explicit Simple(const ParameterList& list);
  static ParameterList valid_parameters();
  std::string name() const override { return "simple"; }

 private:
  RCP<const LinearOperator> make_preconditioner(const BlockSystem& system,
                                                const ScaledSystem& scaled) override;

  double relaxation_;
};

}  // namespace lockstep
