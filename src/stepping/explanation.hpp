#pragma once
#include <string>

#include "stepping/scene.hpp"

namespace lockstep {

/// Tells what is active in a run, why, and what it costs in memory. Collective.
template <int dim>
std::string explanation(Components<dim>& components, PaperStep<dim>& scheme,
                        const SceneOptions& options);

}  // namespace lockstep
