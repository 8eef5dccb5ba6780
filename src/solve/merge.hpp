#pragma once
#include "interfaces/strategy.hpp"

namespace lockstep {

/// Eq. 16 as one matrix, for direct solvers and dumps: pressure unknowns, then solid unknowns, then
/// one multiplier for each null vector n. The multipliers border the singular system,
///   [ K  s n ; s n^T  0 ],
/// so that the matrix is regular and its solution has no component along n.
struct MergedSystem {
  RCP<const CrsMatrix> matrix;
  int n_local_pressure = 0, n_local_solid = 0;
};

/// Throws SolveError if A or C is not assembled. Collective.
MergedSystem merge(const BlockSystem& system);

/// Copies between a block vector and a merged one (multipliers: zero, or dropped).
RCP<Vector> to_merged(const MergedSystem& merged, const BlockVector& vector);
void from_merged(const MergedSystem& merged, const Vector& vector, BlockVector& result);

}  // namespace lockstep
