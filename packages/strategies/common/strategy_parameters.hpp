#pragma once
#include <string>

#include "parameters/parameter_list.hpp"

namespace lockstep {

/// The parameters that all strategies share: "Tolerance" (read by whoever makes the SolveRequest),
/// "Maximum Iterations", "Check Preconditioner Symmetry", "Solid Inverse".
ParameterList common_strategy_parameters();

/// Declares a sublist that preconditioner_from_list reads.
void declare_inverse(ParameterList& list, const std::string& name, const std::string& doc);

/// The sublist `name` of `list`, or `standard` if it is absent or
/// empty. Throws InputError if preconditioner_from_list would not take it.
ParameterList inverse_list(const ParameterList& list, const std::string& name,
                           const ParameterList& standard);

/// `list` with the defaults of `valid` for what it leaves out at its top level.
ParameterList with_defaults(const ParameterList& list, const ParameterList& valid);

}  // namespace lockstep
