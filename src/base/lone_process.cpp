#include "base/lone_process.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>

namespace lockstep {

void expect_no_other_ranks() {
  constexpr std::array<const char*, 4> of_launchers{"OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_RANK",
                                                    "SLURM_PROCID"};
  if (std::any_of(of_launchers.begin(), of_launchers.end(),
                  [](const char* name) { return std::getenv(name) != nullptr; }))
    return;
  // Open MPI starts no daemon and makes no session folder. Several runs at a time would share
  // that folder: some found it there where they had just not seen it, and did not start, others
  // took it away too early.
  setenv("OMPI_MCA_ess_singleton_isolated", "1", 0);
  setenv("OMPI_MCA_orte_create_session_dirs", "0", 0);
  setenv("OMPI_MCA_pml", "ob1", 0);
}

}  // namespace lockstep
