#pragma once
#include "linear/conjugate_gradients.hpp"
#include "strategies/common/refined_strategy.hpp"

namespace lockstep {

/// Conjugate gradients on A p̂ = rhs, for systems without a solid block. Returns the iterations.
/// Collective.
int pressure_cg(const BlockSystem& system, const LinearOperator& pressure_inverse,
                const Vector& rhs, const ConjugateGradientsRequest& request, Vector& solution);

}  // namespace lockstep
