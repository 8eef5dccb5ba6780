#pragma once
#include "strategies/common/gmres_strategy.hpp"

namespace lockstep {

/// Flexible GMRES with Teko's block LU factorisation: an approximate inverse M of A and the Schur
/// complement C + B^T M B, dense, for at most "Largest Solid" solid unknowns. Few iterations at any
/// density; each applies M twice. Refuses regions closed by a dynamic solid.
class BlockLu : public GmresStrategy {
 public:
  explicit BlockLu(const ParameterList& list);
  static ParameterList valid_parameters();
  std::string name() const override { return "block-lu"; }

 private:
  RCP<const LinearOperator> make_preconditioner(const BlockSystem& system,
                                                const ScaledSystem& scaled) override;

  int largest_solid_;
};

}  // namespace lockstep
