#include "output/provenance/build_information.hpp"

#include <Trilinos_version.h>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <hdf5.h>
#include <mpi.h>

#include <ctime>

#include "output/provenance/git_hash.hpp"

namespace lockstep {

BuildInformation build_information() {
  BuildInformation build;
  build.version = LOCKSTEP_VERSION;
  build.git_hash = git_hash;
  build.build_type = LOCKSTEP_BUILD_TYPE;
  build.compiler = LOCKSTEP_COMPILER;
  build.trilinos = TRILINOS_VERSION_STRING;

  char text[MPI_MAX_LIBRARY_VERSION_STRING] = {};
  int length = 0;
  MPI_Get_library_version(text, &length);
  build.mpi = std::string(text).substr(0, std::string(text).find_first_of(",\n"));

  unsigned major = 0, minor = 0, release = 0;
  H5get_libversion(&major, &minor, &release);
  build.hdf5 = fmt::format("{}.{}.{}", major, minor, release);
  return build;
}

std::string banner(const Communicator& comm, const std::string& command_line) {
  const BuildInformation build = build_information();
  return fmt::format(
      "Lockstep {} ({}), {} build, {}\n"
      "Trilinos {}, {}, HDF5 {}\n"
      "{} rank{}, {:%Y-%m-%d %H:%M:%S} UTC\n"
      "{}",
      build.version, build.git_hash, build.build_type, build.compiler, build.trilinos, build.mpi,
      build.hdf5, comm->getSize(), comm->getSize() == 1 ? "" : "s", fmt::gmtime(std::time(nullptr)),
      command_line);
}

}  // namespace lockstep
