#pragma once
#include "base/communicator.hpp"
#include "parameters/source.hpp"

namespace lockstep {

/// Merges the scene files that "Include" names (a string, or an array of them) into the document,
/// paths relative to the file that names them; they may include others. What a file itself says
/// wins over what it includes, and of several the first wins. Throws InputError, also for a file
/// that includes itself. Collective.
void include_scenes(Document& document, const Communicator& comm);

}  // namespace lockstep
