#include "strategies/common/minres_strategy.hpp"

#include "linear/symmetry_check.hpp"
#include "solve/thyra_vectors.hpp"

namespace lockstep {

ParameterList MinresStrategy::minres_parameters(const std::string& standard_method) {
  ParameterList list = common_strategy_parameters();
  declare_minres(list, standard_method);
  return list;
}

MinresStrategy::MinresStrategy(const ParameterList& list, const ParameterList& pressure_list)
    : RefinedStrategy(list, pressure_list), minres_(minres_kind(list)) {}

void MinresStrategy::build(const BlockSystem& system, bool, bool solid_changed) {
  if (!solid_changed)
    return;
  if (minres_ == MinresKind::belos)
    check_no_empty_rank(system, "The strategy " + name());
  preconditioners_ = make_preconditioners(system);
  if (!check_symmetry())
    return;
  check_symmetric_positive(*preconditioners_.pressure, "pressures of the " + system.name,
                           symmetry_tolerance());
  check_symmetric_positive(*preconditioners_.solid, "solids of the " + system.name,
                           symmetry_tolerance());
}

int MinresStrategy::correct(const BlockSystem& system, const CorrectionRequest& request,
                            Vector& correction) {
  if (!system.has_solid())
    return pressure_cg(system, request, correction);
  return solve_by_minres(minres_, system, *request.residual,
                         block_krylov(system, request, Presumes::symmetry),
                         preconditioners_.pressure, preconditioners_.solid, correction);
}

}  // namespace lockstep
