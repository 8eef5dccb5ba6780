#pragma once
#include <vector>

#include "linear/types.hpp"

namespace lockstep {

/// Brings the `wanted` rows of vectors on `owner` to this rank; ids may repeat. Collective.
RCP<Import> import_of(std::vector<GlobalIndex> wanted, const RCP<const Map>& owner);

/// values += the overlapping ones, summed over ranks. Collective.
void add_overlap(const Vector& overlap, const Import& import, Vector& values);

}  // namespace lockstep
