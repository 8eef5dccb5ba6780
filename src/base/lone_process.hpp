#pragma once

namespace lockstep {

/// Tells Open MPI, where no mpirun or batch system has started this process, that it needs no
/// network, no daemon and no folder to meet others in: looking for all that takes longer than many
/// a small run, and runs side by side would meet. What the environment says counts more; other MPI
/// libraries do not look. Call before MPI starts.
void expect_no_other_ranks();

}  // namespace lockstep
