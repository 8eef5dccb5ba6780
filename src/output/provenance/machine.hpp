#pragma once
#include <string>

namespace lockstep {

/// The computer that this process runs on; what it does not tell is empty.
struct Machine {
  std::string host;
  std::string processor;  ///< as /proc/cpuinfo names it
  int cores = 0;          ///< hardware threads
  std::string system;     ///< name and release of the kernel
};

Machine this_machine();

}  // namespace lockstep
