#include "strategies/common/minres_strategy.hpp"

#include <Thyra_DefaultBlockedLinearOp.hpp>

#include "linear/symmetry_check.hpp"

namespace lockstep {

MinresStrategy::MinresStrategy(const ParameterList& list, const ParameterList& pressure_list)
    : RefinedStrategy(list, pressure_list), minres_(minres_list()) {}

void MinresStrategy::build(const BlockSystem& system, bool, bool solid_changed) {
  if (!solid_changed)
    return;
  flat_ = std::make_unique<FlatSystem>(system);
  const Preconditioners parts = make_preconditioners(system);
  preconditioner_ =
      Thyra::block2x2<double>(parts.pressure, Teuchos::null, Teuchos::null, parts.solid);
  if (!check_symmetry())
    return;
  check_symmetric_positive(*parts.pressure, "pressures of the " + system.name,
                           symmetry_tolerance());
  check_symmetric_positive(*parts.solid, "solids of the " + system.name, symmetry_tolerance());
}

int MinresStrategy::correct(const BlockSystem& system, const CorrectionRequest& request,
                            Vector& correction) {
  if (!system.has_solid())
    return pressure_cg(system, request, correction);
  return minres_.correct(system, *flat_, preconditioner_, *request.residual,
                         block_krylov(system, request, Presumes::symmetry), correction);
}

}  // namespace lockstep
