#pragma once
#include "linear/conjugate_gradients.hpp"

namespace lockstep {

/// A square Thyra operator on `map` whose application is `action`, which must be linear. Applying
/// it is collective.
RCP<const LinearOperator> action_operator(const RCP<const Map>& map, Action action);

}  // namespace lockstep
