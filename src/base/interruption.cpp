#include "base/interruption.hpp"

#include <signal.h>

namespace lockstep {

namespace {
volatile std::sig_atomic_t received = 0;
int n_interruptible = 0;
}  // namespace

void note_signal(int signal_number) {
  received = signal_number;
}

int noted_signal() {
  return received;
}

int signal_received(const Communicator& comm) {
  return static_cast<int>(max_all(comm, static_cast<GlobalIndex>(received)));
}

Interruptible::Interruptible() {
  ++n_interruptible;
}

Interruptible::~Interruptible() {
  --n_interruptible;
}

bool is_interruptible() {
  return n_interruptible > 0;
}

HeldSignals::HeldSignals() {
  sigset_t held;
  sigemptyset(&held);
  sigaddset(&held, SIGTERM);
  sigaddset(&held, SIGINT);
  pthread_sigmask(SIG_BLOCK, &held, &before_);
}

HeldSignals::~HeldSignals() {
  pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

void poll_interruption(const Communicator& comm) {
  if (is_interruptible())
    sum_all(comm, 0.0);
}

}  // namespace lockstep
