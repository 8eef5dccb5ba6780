#pragma once
#include <string>

#include "stepping/scene.hpp"

namespace lockstep {

/// Tells what is active in a run, why, what it costs in memory, and what is understood of each
/// solid, with warnings for what is likely a mistake. Collective.
template <int dim>
std::string explanation(Components<dim>& components, TimeScheme<dim>& scheme,
                        const SceneOptions& options);

}  // namespace lockstep
