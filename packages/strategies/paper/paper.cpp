#include "strategies/paper/paper.hpp"

#include "linear/thyra_vectors.hpp"
#include "strategies/common/pressure_inverse.hpp"
#include "strategies/common/solid_preconditioner.hpp"

namespace lockstep {

ParameterList Paper::valid_parameters() {
  ParameterList list = common_strategy_parameters();
  declare_minres(list, "Belos MINRES");
  declare_pressure_inverse(list,
                           "Approximate inverse of the pressure block A. Default: Ifpack2's "
                           "RILUK(0), which is the paper's incomplete Cholesky.");
  declare_solid_inverse(list);
  return list;
}

Paper::Paper(const ParameterList& given)
    : RefinedStrategy(with_defaults(given, valid_parameters()), incomplete_cholesky_list(given)),
      minres_(minres_kind(with_defaults(given, valid_parameters()))),
      solid_list_(solid_inverse_list(given)) {}

void Paper::build(const BlockSystem& system, bool, bool solid_changed) {
  if (system.has_solid() && minres_ == MinresKind::belos)
    check_no_empty_rank(system, "The strategy paper");
  if (solid_changed)
    solid_preconditioner_ =
        solid_preconditioner(system, solid_list_, solid_inverse(), check_symmetry());
}

int Paper::correct(const BlockSystem& system, const CorrectionRequest& request,
                   Vector& correction) {
  if (!system.has_solid())
    return pressure_cg(system, request, correction);
  return solve_by_minres(minres_, system, *request.residual,
                         block_krylov(request, Presumes::symmetry), pressure_inverse(),
                         solid_preconditioner_, correction);
}

}  // namespace lockstep
