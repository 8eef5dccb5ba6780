#pragma once
#include <memory>
#include <string>

#include "interfaces/strategy.hpp"
#include "parameters/registry.hpp"

namespace lockstep {

using StrategyRegistry = Registry<SolverStrategy>;

/// Adds one strategy, a class with a constructor from its list and a static `valid_parameters`.
template <typename Strategy>
void add_strategy(StrategyRegistry& registry, const std::string& name,
                  const std::string& documentation) {
  registry.add(name, documentation, &Strategy::valid_parameters,
               [](const ParameterList& list) { return std::make_unique<Strategy>(list); });
}

/// Adds every strategy of this package.
void register_strategies(StrategyRegistry& registry);

}  // namespace lockstep
