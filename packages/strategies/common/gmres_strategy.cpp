#include "strategies/common/gmres_strategy.hpp"

#include "strategies/common/block_krylov.hpp"
#include "strategies/common/pressure_inverse.hpp"

namespace lockstep {

ParameterList GmresStrategy::gmres_parameters() {
  ParameterList list = common_strategy_parameters();
  declare_pressure_inverse(list,
                           "Approximate inverse of the pressure block A. Default: Automatic.");
  declare_positive(list, "Restart", 60,
                   "Iterations of GMRES until it restarts; it stores two "
                   "vectors for each");
  return list;
}

GmresStrategy::GmresStrategy(const ParameterList& list, const ParameterList& pressure_list,
                             PressureOrder order)
    : RefinedStrategy(list, pressure_list, order), restart_(list.get<int>("Restart")) {}

void GmresStrategy::build(const BlockSystem& system, bool, bool solid_changed) {
  if (!solid_changed)
    return;
  scaled_ = {};
  scaled_ = scaled_system(system, "The strategy " + name());
  scaled_.preconditioner = make_preconditioner(system, scaled_);
}

int GmresStrategy::correct(const BlockSystem& system, const CorrectionRequest& request,
                           Vector& correction) {
  if (!system.has_solid())
    return pressure_cg(system, request, correction);
  return solve_by_flexible_gmres(scaled_, *request.residual,
                                 block_krylov(system, request, Presumes::nothing), restart_,
                                 correction);
}

}  // namespace lockstep
