#pragma once
#include "interfaces/strategy.hpp"

namespace lockstep {

/// The diagonal of B diag(C)^-1 B^T on the rows of A, whose map is `map`; zero without an assembled
/// C, and where entries of B are round-off of a sum that cancels. Collective.
RCP<Vector> added_mass_diagonal(const BlockSystem& system, const RCP<const Map>& map);

}  // namespace lockstep
