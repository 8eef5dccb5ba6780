#include "strategies/common/solid_preconditioner.hpp"

#include "linear/preconditioner.hpp"
#include "linear/symmetry_check.hpp"

namespace lockstep {

void declare_solid_inverse(ParameterList& list) {
  declare_inverse(list, "Solid Inverse",
                  "Approximate inverse of the solid block C. Default: Exact.");
}

ParameterList solid_inverse_list(const ParameterList& list) {
  ParameterList standard;
  standard.set("Type", "Exact");
  return inverse_list(list, "Solid Inverse", standard);
}

RCP<const LinearOperator> solid_preconditioner(const BlockSystem& system, const ParameterList& list,
                                               const RCP<const LinearOperator>& exact,
                                               bool check_symmetry) {
  const std::string name = "solid block of the " + system.name;
  const auto inverse = list.get<std::string>("Type") == "Exact"
                           ? exact
                           : preconditioner_from_list(system.solid_block, list, name);
  if (check_symmetry)
    check_symmetric_positive(*inverse, name);
  return inverse;
}

}  // namespace lockstep
