#include "base/wait_for_all.hpp"

#include <ctime>

namespace lockstep {

bool wait_for_all(const Communicator& comm) {
  if (comm->getSize() == 1)
    return true;
  int all_here = 0;
  static int mine = 1, sum = 0;  // MPI may still write them after this call
  MPI_Request request;
  MPI_Iallreduce(&mine, &sum, 1, MPI_INT, MPI_SUM, raw_communicator(comm), &request);
  for (int wait = 0; wait < 50 && !all_here; ++wait) {
    MPI_Test(&request, &all_here, MPI_STATUS_IGNORE);
    if (!all_here) {
      struct timespec pause = {0, 20000000};
      nanosleep(&pause, nullptr);
    }
  }
  return all_here != 0;
}

}  // namespace lockstep
