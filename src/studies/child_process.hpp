#pragma once
#include <string>
#include <vector>

namespace lockstep {

/// End of a child process: its exit code, or 128 + the signal that ended it.
struct ChildResult {
  int exit_code = 0;
  double wall_seconds = 0;
};

/// Runs a program (found through PATH unless its name has a '/') and waits for it. What it prints
/// goes to the two files; its environment is ours plus what Open MPI needs to start as root and on
/// more ranks than cores, and one thread a rank. It ends if this program is killed. Throws
/// OutputError if it cannot be started.
ChildResult run_child(const std::vector<std::string>& command, const std::string& output_file,
                      const std::string& error_file);

/// From now on SIGTERM and SIGINT are handed to the children that run, instead of ending this
/// program: they end in their own way, and `run_child` reports it.
void forward_signals_to_children();
/// The last one that came since, whether or not a child ran; 0: none.
int forwarded_signal();

}  // namespace lockstep
