#pragma once
#include <vector>

#include "linear/types.hpp"

namespace lockstep {

/// Removes from x its components along the orthonormal `basis`; returns the norm of what was
/// removed. Collective.
double project_out(const std::vector<RCP<const Vector>>& basis, Vector& x);

}  // namespace lockstep
