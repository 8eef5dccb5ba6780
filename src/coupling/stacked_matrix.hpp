#pragma once
#include <vector>

#include "coupling/stacked_operator.hpp"

namespace lockstep {

/// Are the masses and forces of all parts assembled matrices?
bool all_assembled(const std::vector<StackedPart>& parts);

/// blockdiag(mass_m - dt D_m) + added, all of them assembled, with a 1 on the diagonal of
/// `unit_rows` (local numbers). `added` may be null. Collective.
RCP<CrsMatrix> stacked_matrix(const std::vector<StackedPart>& parts, double dt,
                              const RCP<const CrsMatrix>& added, const RCP<const Map>& map,
                              const std::vector<int>& unit_rows);

}  // namespace lockstep
