#pragma once
#include <functional>
#include <memory>
#include <set>
#include <string>

#include "conformance/violations.hpp"
#include "interfaces/strategy.hpp"
#include "linear/types.hpp"

namespace lockstep {

/// Holds a strategy against what SolverStrategy promises, on small coupled systems (water around
/// two plates, open and closed, with a piston, light and heavy, and without solids). `make` gives a
/// new one, as it is at the start of a run. It must solve all of them but those in `may_refuse`,
/// which it may refuse with a SolveError; they go by the names in sentences, such as "open tank,
/// plates of 1 kg". Collective; every rank gets the same sentences.
Violations check_strategy(const std::function<std::unique_ptr<SolverStrategy>()>& make,
                          const Communicator& comm, std::set<std::string> may_refuse = {});

}  // namespace lockstep
