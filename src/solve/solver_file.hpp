#pragma once
#include <string>

#include "base/communicator.hpp"
#include "parameters/source.hpp"

namespace lockstep {

/// Reads the list of a solver strategy from a parameter file. A list that Stratimikos reads, as
/// other programs have them, lacks "Type": it is one of the strategy "stratimikos". Throws
/// InputError. Collective.
Document read_solver_file(const std::string& path, const Communicator& comm);

/// Throws InputError if a list of a strategy has the "Type" of one that is a list of "stratimikos"
/// now, or is no more; `place` is for the message.
void check_strategy_is_not_gone(const ParameterList& list, const std::string& place);

}  // namespace lockstep
