#pragma once
#include <vector>

#include "linear/types.hpp"

namespace lockstep {

/// R^-1 - (1 - yield) R^-1 D (D^T R^-1 D)^+ D^T R^-1: what is left of a response, velocities from
/// impulses, where closed fluid lets solids not move along the impulses D
/// (`CoupledSystem::locked_directions`) but by the part `yield` [1] of what they would without it.
/// Symmetric and positive semidefinite as R^-1 is definite. `response` itself if there are none.
/// Collective, and so is every application.
RCP<const LinearOperator> locked_response(const RCP<const LinearOperator>& response,
                                          const std::vector<RCP<const Vector>>& directions,
                                          double yield = 0);

}  // namespace lockstep
