#pragma once
#include <vector>

#include "linear/types.hpp"

namespace lockstep {

/// Removes from x its components along the orthonormal `basis`; returns the norm of what was
/// removed. Collective.
double project_out(const std::vector<RCP<const Vector>>& basis, Vector& x);

/// The same, relative to the norm of x before (0 for x = 0). Collective.
double relative_part_removed(const std::vector<RCP<const Vector>>& basis, Vector& x);

}  // namespace lockstep
