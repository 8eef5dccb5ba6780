#include "base/memory.hpp"

#include <malloc.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <fstream>

namespace lockstep {

namespace {

/// Memory of this machine [bytes]; a container may be allowed less.
double memory_of_machine() {
  const double installed = static_cast<double>(sysconf(_SC_PHYS_PAGES)) * sysconf(_SC_PAGE_SIZE);
  double allowed = 0;
  std::ifstream limit("/sys/fs/cgroup/memory.max");
  return limit >> allowed && allowed > 0 ? std::min(installed, allowed) : installed;
}

/// True if the system hands out address space only as far as it has memory for all of it.
bool counts_address_space() {
  int mode = 0;
  std::ifstream("/proc/sys/vm/overcommit_memory") >> mode;
  return mode == 2;
}

/// Grows the heap by address space, asks for huge pages there and frees it again: what is allocated
/// later comes from it, and only what is written to takes memory.
void ask_for_huge_pages() {
  if (counts_address_space())
    return;
  const auto size = static_cast<std::size_t>(memory_of_machine() / 2);
  void* const block = std::malloc(size);
  if (block == nullptr)
    return;
  const auto page = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE));
  const auto begin = reinterpret_cast<std::uintptr_t>(block) / page * page + page;
  const std::uintptr_t end = (reinterpret_cast<std::uintptr_t>(block) + size) / page * page;
  madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);  // a wish: it may fail
  std::free(block);
}

}  // namespace

void keep_freed_memory() {
  mallopt(M_MMAP_MAX, 0);
  mallopt(M_TRIM_THRESHOLD, -1);
  ask_for_huge_pages();
}

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
