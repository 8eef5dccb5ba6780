#pragma once
#include "base/communicator.hpp"

namespace lockstep {

/// Keeps large freed blocks of memory in the process for the next field or vector of that size:
/// given back, every one would be zeroed page by page again when it is next asked for. For programs
/// whose steps allocate what the last step freed. Asks for huge pages too: a step looks at more
/// small ones than a processor keeps addresses of. Call once, at the start.
void keep_freed_memory();

/// Memory of the machines that the ranks run on, each counted once, or the part that they may use
/// [bytes]. Collective.
double memory_of_machines(const Communicator& comm);

}  // namespace lockstep
