#pragma once
#include "interfaces/strategy.hpp"
#include "parameters/registry.hpp"

namespace lockstep {

using StrategyRegistry = Registry<SolverStrategy>;

/// Adds "paper", "schur-cg" and "direct".
void register_strategies(StrategyRegistry& registry);

}  // namespace lockstep
