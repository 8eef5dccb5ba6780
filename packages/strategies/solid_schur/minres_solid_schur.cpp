#include "strategies/solid_schur/minres_solid_schur.hpp"

#include "linear/symmetry_check.hpp"
#include "strategies/common/pressure_inverse.hpp"
#include "strategies/common/solid_schur.hpp"

namespace lockstep {

ParameterList MinresSolidSchur::valid_parameters() {
  ParameterList list = common_strategy_parameters();
  declare_minres(list, "Lockstep MINRES");
  declare_pressure_inverse(list,
                           "Approximate inverse of the pressure block A. Default: Automatic.");
  declare_positive(list, "Largest Solid", 300,
                   "Systems of more solid unknowns are refused: A is inverted once for each");
  return list;
}

MinresSolidSchur::MinresSolidSchur(const ParameterList& given)
    : RefinedStrategy(with_defaults(given, valid_parameters()),
                      pressure_inverse_list(given, "Automatic")),
      minres_(minres_kind(with_defaults(given, valid_parameters()))),
      largest_solid_(with_defaults(given, valid_parameters()).get<int>("Largest Solid")) {}

void MinresSolidSchur::build(const BlockSystem& system, bool, bool solid_changed) {
  if (!solid_changed)
    return;
  refuse_region_closed_by_solid(system);
  solid_preconditioner_ =
      SolidSchur::make(system, pressure_inverse(), largest_solid_, name())->inverse();
  if (check_symmetry())
    check_symmetric_positive(*solid_preconditioner_, "solid Schur complement of the " + system.name,
                             symmetry_tolerance());
}

int MinresSolidSchur::correct(const BlockSystem& system, const CorrectionRequest& request,
                              Vector& correction) {
  if (!system.has_solid())
    return pressure_cg(system, request, correction);
  return solve_by_minres(minres_, system, *request.residual,
                         block_krylov(request, Presumes::symmetry), pressure_inverse(),
                         solid_preconditioner_, correction);
}

}  // namespace lockstep
