#pragma once
#include <csignal>

#include "base/communicator.hpp"

namespace lockstep {

/// From now on the first two of SIGTERM, SIGINT, SIGHUP, SIGUSR1, SIGUSR2 are only noted, so that
/// the run can end after its step, with a checkpoint and exit code 128 + their number; the third
/// ends the process at once. SIGXCPU is noted likewise, however often it comes. SIGPIPE is ignored,
/// and SIGHUP where it was. Note that mpirun, when itself told to stop, kills its ranks a second
/// later unless its parameter odls_base_sigkill_timeout says otherwise.
void install_signal_handlers();
/// Lets no write into a pipe that nobody reads any more end the program: the log may go into one,
/// and the files of the run are what counts. Part of `install_signal_handlers`. Local.
void ignore_closed_pipes();

/// Notes a signal as its handler does; 0 forgets it.
void note_signal(int signal_number);
/// The number of a signal that this rank has noted, or 0. Local.
int noted_signal();
/// The number of a signal that any rank has noted, or 0. Collective.
int signal_received(const Communicator& comm);

/// While one lives, these signals wait. For calls of METIS, which takes SIGTERM for an error
/// of its own, jumps out of what it does and is of no use afterwards; and while MPI starts threads,
/// so that they leave the signals to this one. Local.
class HeldSignals {
 public:
  HeldSignals();
  ~HeldSignals();
  HeldSignals(const HeldSignals&) = delete;
  HeldSignals& operator=(const HeldSignals&) = delete;

 private:
  sigset_t before_;
};

}  // namespace lockstep
