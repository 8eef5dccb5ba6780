#pragma once
#include "base/communicator.hpp"

namespace lockstep {

/// From now on the first SIGTERM or SIGINT is only noted, so that the run can write a checkpoint
/// and stop; the third ends the process at once. Note that mpirun, when itself told to stop, kills
/// its ranks a second later unless its parameter odls_base_sigkill_timeout says otherwise.
void install_signal_handlers();

/// Collective: 0, or the number of a signal that any rank has received. Exit with 128 + that
/// number.
int stop_requested(const Communicator& comm);

}  // namespace lockstep
