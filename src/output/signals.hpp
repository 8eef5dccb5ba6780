#pragma once
namespace lockstep {

/// Installs handlers: from now on the first SIGTERM or SIGINT is only noted
/// (base/interruption.hpp), so that the run can write a checkpoint and stop with exit code 128 +
/// its number; the third ends the process at once. Note that mpirun, when itself told to stop,
/// kills its ranks a second later unless its parameter odls_base_sigkill_timeout says otherwise.
void install_signal_handlers();

}  // namespace lockstep
