#pragma once
#include "strategies/common/gmres_strategy.hpp"

namespace lockstep {

/// Flexible GMRES with Teko's block Gauss-Seidel, lower triangle: the fluid first, then the solid
/// with that pressure, as a partitioned code would go. Cheap to set up; iterations grow with the
/// added mass over the solid's.
class GaussSeidel : public GmresStrategy {
 public:
  explicit GaussSeidel(const ParameterList& list);
  static ParameterList valid_parameters();
  std::string name() const override { return "gauss-seidel"; }

 private:
  RCP<const LinearOperator> make_preconditioner(const BlockSystem& system,
                                                const ScaledSystem& scaled) override;
};

}  // namespace lockstep
