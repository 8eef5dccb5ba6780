#include "strategies/paper/paper.hpp"

#include "strategies/common/pressure_inverse.hpp"
#include "strategies/common/solid_preconditioner.hpp"

namespace lockstep {

ParameterList Paper::valid_parameters() {
  ParameterList list = minres_parameters("Belos MINRES");
  declare_pressure_inverse(list,
                           "Approximate inverse of the pressure block A. Default: Ifpack2's "
                           "RILUK(0), which is the paper's incomplete Cholesky.");
  declare_solid_inverse(list);
  return list;
}

Paper::Paper(const ParameterList& given)
    : MinresStrategy(with_defaults(given, valid_parameters()), incomplete_cholesky_list(given)),
      solid_list_(solid_inverse_list(given)) {}

MinresStrategy::Preconditioners Paper::make_preconditioners(const BlockSystem& system) {
  return {pressure_inverse(), solid_preconditioner(system, solid_list_, solid_inverse())};
}

}  // namespace lockstep
