#pragma once
#include <string>

#include "base/communicator.hpp"

namespace lockstep {

/// Sources and tools that this executable was built from.
struct BuildInformation {
  std::string version;
  std::string git_hash;  ///< with "-dirty" if there were changes; "unknown" outside a repository
  std::string build_type;
  std::string compiler;
  std::string trilinos;
  std::string mpi;
  std::string hdf5;
};

BuildInformation build_information();

/// The lines at the start of a run: build, ranks, date (UTC) and command line.
std::string banner(const Communicator& comm, const std::string& command_line);

}  // namespace lockstep
