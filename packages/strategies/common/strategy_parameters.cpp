#include "strategies/common/strategy_parameters.hpp"

#include "solve/preconditioner.hpp"
#include "strategies/common/solid_inverse.hpp"

namespace lockstep {

ParameterList common_strategy_parameters() {
  ParameterList list;
  declare_positive(list, "Tolerance", 1e-8,
                   "Residual that each block must reach, over the largest of the norms of its "
                   "right-hand side and of the terms of its rows [1]");
  declare_positive(list, "Maximum Iterations", 2000,
                   "Iterations of one solve, all restarts together");
  declare(list, "Check Preconditioner Symmetry", false,
          "Debugging: check on random vectors that every preconditioner is symmetric positive "
          "definite");
  declare_solid_inverse(list);
  return list;
}

void declare_inverse(ParameterList& list, const std::string& name, const std::string& doc) {
  declare_free_sublist(
      list, name,
      doc +
          " \"Type\" is Ifpack2 or MueLu (the other parameters go to that package unchanged), "
          "Incomplete Cholesky, Direct, Block Diagonal, Block Diagonal Mass, Jacobi, Additive "
          "Multilevel, Conjugate Gradients or Exact.");
}

ParameterList inverse_list(const ParameterList& list, const std::string& name,
                           const ParameterList& standard) {
  if (!list.isSublist(name) || list.sublist(name).numParams() == 0)
    return standard;
  check_preconditioner_list(list.sublist(name), "\"" + name + "\"");
  return list.sublist(name);
}

ParameterList with_defaults(const ParameterList& list, const ParameterList& valid) {
  ParameterList result(list);
  result.setParametersNotAlreadySet(valid);
  return result;
}

}  // namespace lockstep
