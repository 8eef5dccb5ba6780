#pragma once
#include "base/communicator.hpp"

namespace lockstep {

/// Waits until all ranks call this, for a second at most. False: others went another way, as where
/// this rank alone has failed; then they cannot be reached any more.
bool wait_for_all(const Communicator& comm);

}  // namespace lockstep
