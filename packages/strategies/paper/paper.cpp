#include "strategies/paper/paper.hpp"

#include "strategies/common/pressure_inverse.hpp"

namespace lockstep {

ParameterList Paper::valid_parameters() {
  ParameterList list = common_strategy_parameters();
  declare_pressure_inverse(list,
                           "Approximate inverse of the pressure block A. Default: Incomplete "
                           "Cholesky, as in the paper.");
  return list;
}

Paper::Paper(const ParameterList& given)
    : MinresStrategy(with_defaults(given, valid_parameters()), incomplete_cholesky_list(given)) {}

MinresStrategy::Preconditioners Paper::make_preconditioners(const BlockSystem&) {
  return {pressure_inverse(), solid().is_automatic() ? solid().exact() : solid().approximate()};
}

}  // namespace lockstep
