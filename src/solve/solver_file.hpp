#pragma once
#include <string>

#include "base/communicator.hpp"
#include "parameters/source.hpp"

namespace lockstep {

/// Reads the list of a solver strategy from an XML file. A list that Stratimikos reads, as other
/// programs have them, lacks "Type": it is one of the strategy "stratimikos". Throws InputError.
/// Collective.
Document read_solver_file(const std::string& path, const Communicator& comm);

}  // namespace lockstep
