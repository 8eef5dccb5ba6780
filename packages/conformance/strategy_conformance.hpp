#pragma once
#include <functional>
#include <memory>

#include "conformance/violations.hpp"
#include "interfaces/strategy.hpp"
#include "linear/types.hpp"

namespace lockstep {

/// Holds a strategy against what SolverStrategy promises, on small coupled systems (water around
/// two plates, open and closed, with a piston, light and heavy, and without solids). `make` gives a
/// new one, as it is at the start of a run. It may refuse a system with a SolveError, but not all
/// of those with solids. Collective; every rank gets the same sentences.
Violations check_strategy(const std::function<std::unique_ptr<SolverStrategy>()>& make,
                          const Communicator& comm);

}  // namespace lockstep
