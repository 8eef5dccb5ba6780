#include "output/provenance/machine.hpp"

#include <sys/utsname.h>

#include <fstream>
#include <thread>

namespace lockstep {

namespace {

std::string processor_name() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const std::size_t colon = line.find(": ");
    if (line.rfind("model name", 0) == 0 && colon != std::string::npos)
      return line.substr(colon + 2);
  }
  return "";
}

}  // namespace

Machine this_machine() {
  Machine machine;
  machine.processor = processor_name();
  machine.cores = static_cast<int>(std::thread::hardware_concurrency());
  utsname names = {};
  if (uname(&names) == 0) {
    machine.host = names.nodename;
    machine.system = std::string(names.sysname) + " " + names.release;
    if (machine.processor.empty())
      machine.processor = names.machine;
  }
  return machine;
}

}  // namespace lockstep
