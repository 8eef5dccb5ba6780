#pragma once
#include "base/types.hpp"
#include "parameters/mistakes.hpp"
#include "parameters/parameter_list.hpp"

namespace lockstep {

/// Adds the mistakes that parts of a free surface show by themselves, in a validated list "Fluid".
/// `periodic`: the axes of the domain that are.
template <int dim>
void find_liquid_mistakes(const ParameterList& fluid, const Point<dim>& gravity,
                          const std::array<bool, dim>& periodic, Mistakes& mistakes);

}  // namespace lockstep
