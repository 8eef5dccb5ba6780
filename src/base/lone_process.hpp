#pragma once

namespace lockstep {

/// Tells Open MPI, where no mpirun or batch system has started this process, that it needs no
/// network: looking at all there are would take longer than many a small run. What the environment
/// says counts more; other MPI libraries do not look. Call before MPI starts.
void expect_no_other_ranks();

}  // namespace lockstep
