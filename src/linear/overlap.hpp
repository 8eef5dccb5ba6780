#pragma once
#include <vector>

#include "linear/types.hpp"

namespace lockstep {

/// Brings the `wanted` rows of vectors on `owner` to this rank; ids may repeat. Collective.
RCP<Import> import_of(std::vector<GlobalIndex> wanted, const RCP<const Map>& owner);

/// The values of all columns that this rank's rows of a matrix have, from a vector on its domain.
/// Collective.
RCP<Vector> on_columns(const CrsMatrix& matrix, const Vector& values);

/// values += the overlapping ones, summed over ranks. Collective.
void add_overlap(const Vector& overlap, const Import& import, Vector& values);

}  // namespace lockstep
