#pragma once
#include "solve/preconditioner.hpp"

namespace lockstep {

/// The parameters that all strategies share: "Tolerance" (read by whoever makes the SolveRequest,
/// which a scene's "Solver/Tolerance" overrides), "Maximum Iterations", "Check Preconditioner
/// Symmetry", "Solid Inverse".
ParameterList common_strategy_parameters();

/// `list` with the defaults of `valid` for what it leaves out at its top level.
ParameterList with_defaults(const ParameterList& list, const ParameterList& valid);

}  // namespace lockstep
