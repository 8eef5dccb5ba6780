#pragma once
#include "interfaces/strategy.hpp"
#include "strategies/common/strategy_parameters.hpp"

namespace lockstep {

/// Declares "Solid Inverse", the list that names the approximate inverse of C; "Exact" unless
/// given.
void declare_solid_inverse(ParameterList& list);
/// The list given, checked, or "Exact". Throws InputError.
ParameterList solid_inverse_list(const ParameterList& list);

/// What that list names, symmetric positive definite; `exact` if it says so. Throws SolveError if
/// C does not allow it. Collective.
RCP<const LinearOperator> solid_preconditioner(const BlockSystem& system, const ParameterList& list,
                                               const RCP<const LinearOperator>& exact);

}  // namespace lockstep
