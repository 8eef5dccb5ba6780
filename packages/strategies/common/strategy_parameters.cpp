#include "strategies/common/strategy_parameters.hpp"

#include "strategies/common/solid_inverse.hpp"

namespace lockstep {

ParameterList common_strategy_parameters() {
  ParameterList list;
  declare_tolerance(
      list, "Tolerance", 1e-8,
      "Residual that each block must reach, over the largest of the norms of its "
      "right-hand side and of the terms of its rows [1]. Of a scene, \"Tolerance\" in "
      "\"Solver\" wins where it is given");
  declare_positive(list, "Maximum Iterations", 2000,
                   "Iterations of one solve, all restarts together");
  declare(list, "Check Preconditioner Symmetry", false,
          "Debugging: check on random vectors that every preconditioner is symmetric positive "
          "definite");
  declare_solid_inverse(list);
  return list;
}

ParameterList with_defaults(const ParameterList& list, const ParameterList& valid) {
  ParameterList result(list);
  result.setParametersNotAlreadySet(valid);
  return result;
}

}  // namespace lockstep
