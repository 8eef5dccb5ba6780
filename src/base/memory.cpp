#include "base/memory.hpp"

#include <malloc.h>

#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <limits>

namespace lockstep {

void keep_freed_memory() {
  mallopt(M_MMAP_THRESHOLD, std::numeric_limits<int>::max());
  mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
}

namespace {

/// Of this machine; a container may be allowed less.
double memory_of_machine() {
  const double installed = static_cast<double>(sysconf(_SC_PHYS_PAGES)) * sysconf(_SC_PAGE_SIZE);
  double allowed = 0;
  std::ifstream limit("/sys/fs/cgroup/memory.max");
  return limit >> allowed && allowed > 0 ? std::min(installed, allowed) : installed;
}

}  // namespace

double memory_of_machines(const Communicator& comm) {
  const MPI_Comm all = raw_communicator(comm);
  MPI_Comm machine;
  MPI_Comm_split_type(all, MPI_COMM_TYPE_SHARED, comm->getRank(), MPI_INFO_NULL, &machine);
  int rank_of_machine = 0;
  MPI_Comm_rank(machine, &rank_of_machine);
  MPI_Comm_free(&machine);
  return sum_all(comm, rank_of_machine == 0 ? memory_of_machine() : 0.0);
}

}  // namespace lockstep
