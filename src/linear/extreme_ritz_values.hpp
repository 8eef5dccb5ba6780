#pragma once
#include "linear/conjugate_gradients.hpp"

namespace lockstep {

struct RitzValues {
  double smallest = 0, largest = 0;
};

/// Estimates, from inside, of the extreme eigenvalues of M K on the complement of the null vectors
/// of K, both symmetric positive (semi)definite: Lanczos' by way of `n_steps` of conjugate
/// gradients from a pseudo-random vector that does not depend on the ranks. Collective.
RitzValues extreme_ritz_values(const Action& op, const Action& preconditioner,
                               const RCP<const Map>& map, const NullSpace& null_space, int n_steps);

}  // namespace lockstep
