#include "output/signals.hpp"

#include <signal.h>

#include <csignal>

#include "base/interruption.hpp"

namespace lockstep {

namespace {
volatile std::sig_atomic_t n_received = 0;

void handle_signal(int signal_number) {
  note_signal(signal_number);
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
  sigaction(SIGTERM, &action, nullptr);
  sigaction(SIGINT, &action, nullptr);
  // Beyond a limit of the size of files, writing fails with a message instead.
  signal(SIGXFSZ, SIG_IGN);
}

}  // namespace lockstep
