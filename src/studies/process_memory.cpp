#include "studies/process_memory.hpp"

#include <malloc.h>

#include <cstdlib>
#include <fstream>
#include <string>

namespace lockstep {

namespace {

/// A line of the kernel's account of this process, "VmRSS:  1234 kB" [MB]; 0 if there is none.
double memory_line(const std::string& name) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.rfind(name + ":", 0) == 0)
      return std::strtod(line.c_str() + name.size() + 1, nullptr) * 1024e-6;
  }
  return 0;
}

}  // namespace

double restart_peak_memory() {
  malloc_trim(0);  // returns free memory, which would hide new allocations
  std::ofstream("/proc/self/clear_refs") << "5";
  return memory_line("VmRSS");
}

double peak_memory_since_restart() {
  return memory_line("VmHWM");
}

}  // namespace lockstep
