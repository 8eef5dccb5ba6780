#include "strategies/common/solid_preconditioner.hpp"

#include "linear/preconditioner.hpp"

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
                                               const RCP<const LinearOperator>& exact) {
  if (list.get<std::string>("Type") == "Exact")
    return exact;
  return preconditioner_from_list(system.solid_block, list, "solid block of the " + system.name);
}

}  // namespace lockstep
