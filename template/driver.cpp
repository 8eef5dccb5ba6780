// The frame of every Lockstep program: start MPI and Kokkos, work, report a failure once.
#include <fmt/format.h>

#include <Tpetra_Core.hpp>
#include <cstdio>

#include "base/communicator.hpp"
#include "base/errors.hpp"

namespace {

void run(const lockstep::Communicator& comm) {
  // 1. The work of this program. Here: how far the ranks of a run are apart in their numbering.
  const double rank = comm->getRank();
  const double spread = lockstep::max_all(comm, rank) - lockstep::min_all(comm, rank);
  lockstep::check_solve(spread == comm->getSize() - 1, "The ranks span {} numbers instead of {}.",
                        spread + 1, comm->getSize());

  // 2. One line for the reader, from one rank.
  if (lockstep::is_root(comm))
    fmt::print("Lockstep runs on {} ranks.\n", comm->getSize());
}

}  // namespace

int main(int argc, char** argv) {
  Tpetra::ScopeGuard scope(&argc, &argv);
  const lockstep::Communicator comm = Tpetra::getDefaultComm();
  try {
    run(comm);
  } catch (const lockstep::Failure& failure) {
    if (lockstep::is_root(comm))
      fmt::print(stderr, "{}\n", failure.what());
    return static_cast<int>(failure.exit_code());
  }
  return 0;
}
