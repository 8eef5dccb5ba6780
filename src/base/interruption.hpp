#pragma once
#include <csignal>

#include "base/communicator.hpp"

namespace lockstep {

/// Thrown on all ranks alike where a run that has been told to stop can be left. No std::exception,
/// so that what turns those of other libraries into ours lets it pass.
struct Interrupted {
  int signal = 0;
};

/// A signal was received; may be called by its handler.
void note_signal(int signal_number);
/// Collective: 0, or the number of a signal that any rank has received.
int signal_received(const Communicator& comm);

/// While one lives, sums over all ranks (`sum_all` of one number) and `poll_interruption` throw
/// Interrupted once any rank has received a signal. The sums carry the question along, so that the
/// many of a solve ask it at no cost, and the ranks always agree. Make it on all ranks, where
/// nothing that is changed meanwhile is needed after an interruption.
class Interruptible {
 public:
  Interruptible();
  ~Interruptible();
  Interruptible(const Interruptible&) = delete;
  Interruptible& operator=(const Interruptible&) = delete;
};
bool is_interruptible();
/// The number of a signal that this rank has received, or 0. Local.
int noted_signal();

/// While one lives, SIGTERM and SIGINT wait. For calls of METIS, which takes SIGTERM for an error
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

/// Throws Interrupted after a signal, between long pieces of work without such sums; does nothing
/// outside of an Interruptible. Collective.
void poll_interruption(const Communicator& comm);

}  // namespace lockstep
