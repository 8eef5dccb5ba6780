#include "base/signals.hpp"

#include <signal.h>

namespace lockstep {

namespace {
volatile std::sig_atomic_t noted = 0;
volatile std::sig_atomic_t n_received = 0;

/// Sent by people and batch systems that want a run to end.
constexpr int ending_signals[] = {SIGTERM, SIGINT, SIGHUP, SIGUSR1, SIGUSR2, SIGXCPU};

void handle_signal(int signal_number) {
  note_signal(signal_number);
  if (signal_number == SIGXCPU)  // comes again each second
    return;
  n_received = n_received + 1;
  if (n_received >= 3) {
    signal(signal_number, SIG_DFL);
    raise(signal_number);
  }
}
}  // namespace

void install_signal_handlers() {
  struct sigaction action {};
  action.sa_handler = handle_signal;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  for (const int number : ending_signals) {
    struct sigaction before {};
    sigaction(number, nullptr, &before);
    if (number != SIGHUP || before.sa_handler != SIG_IGN)  // nohup has it ignored
      sigaction(number, &action, nullptr);
  }
  // Beyond a limit of the size of files, writing fails with a message instead.
  signal(SIGXFSZ, SIG_IGN);
  ignore_closed_pipes();
}

void ignore_closed_pipes() {
  signal(SIGPIPE, SIG_IGN);
}

void note_signal(int signal_number) {
  noted = signal_number;
}

int noted_signal() {
  return noted;
}

int signal_received(const Communicator& comm) {
  return static_cast<int>(max_all(comm, static_cast<GlobalIndex>(noted)));
}

HeldSignals::HeldSignals() {
  sigset_t held;
  sigemptyset(&held);
  for (const int number : ending_signals)
    sigaddset(&held, number);
  pthread_sigmask(SIG_BLOCK, &held, &before_);
}

HeldSignals::~HeldSignals() {
  pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

}  // namespace lockstep
