#pragma once
#include "base/types.hpp"
#include "parameters/mistakes.hpp"
#include "parameters/parameter_list.hpp"

namespace lockstep {

/// Adds the mistakes of "Smoke", "Temperature" and "Sources" in a validated list "Fluid". `bounds`:
/// the domain [m].
template <int dim>
void find_scalar_mistakes(const ParameterList& fluid, const Box<dim>& bounds, Mistakes& mistakes);

}  // namespace lockstep
