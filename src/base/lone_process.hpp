#pragma once

namespace lockstep {

/// Tells Open MPI, where no mpirun or batch system has started this process, that it needs neither
/// a daemon nor a network: it would spend two thirds of a small run's time on these. What the
/// environment says counts more; other MPI libraries do not look. Call before MPI starts.
void expect_no_other_ranks();

}  // namespace lockstep
