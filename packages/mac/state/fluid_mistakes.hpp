#pragma once
#include "parameters/mistakes.hpp"
#include "parameters/parameter_list.hpp"

namespace lockstep {

/// Adds the mistakes of the parts of a fluid and its domain, validated lists, that each part shows
/// by itself: sides, phases, sources, shapes of the liquid, watches. For a fluid that cannot be
/// built. Local.
template <int dim>
void find_fluid_mistakes(const ParameterList& fluid, const ParameterList& domain,
                         Mistakes& mistakes);

}  // namespace lockstep
