#pragma once
#include <vector>

#include "coupling/stacked_operator.hpp"
#include "linear/triplet_matrix.hpp"

namespace lockstep {

/// Are the masses and forces of all parts assembled matrices?
bool all_assembled(const std::vector<StackedPart>& parts);

/// blockdiag(mass_m - dt D_m) + added, all of them assembled, with a 1 on the diagonal of
/// `unit_rows` (local numbers). `added` may be null. Collective.
RCP<CrsMatrix> stacked_matrix(const std::vector<StackedPart>& parts, double dt,
                              const RCP<const CrsMatrix>& added, const RCP<const Map>& map,
                              const std::vector<int>& unit_rows);

/// The entries of blockdiag(mass_m - dt D_m), all of them assembled. Local rows.
std::vector<Triplet> stacked_triplets(const std::vector<StackedPart>& parts, double dt);

/// Adds `factor` times the matrix, its ids shifted. Local rows.
void add_triplets(const CrsMatrix& matrix, GlobalIndex shift, double factor,
                  std::vector<Triplet>& triplets);

/// mask K mask + (1 - mask), in place. Collective.
void eliminate_masked(CrsMatrix& matrix, const Vector& mask);

}  // namespace lockstep
