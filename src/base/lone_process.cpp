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
  // Not ess_singleton_isolated too, which would spare a daemon: several at a time would share one
  // session folder, and one would take it away from the others.
  setenv("OMPI_MCA_pml", "ob1", 0);
}

}  // namespace lockstep
