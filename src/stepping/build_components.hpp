#pragma once
#include <string>

#include "interfaces/registries.hpp"
#include "stepping/step/components.hpp"

namespace lockstep {

/// Builds the plug-ins of a validated scene. `scene_file` resolves relative mesh files. Each part
/// that does not need what failed is built, too: throws InputError with all mistakes. Collective.
template <int dim>
Components<dim> build_components(const Registries<dim>& registries, const ParameterList& scene,
                                 const std::string& scene_file, const Communicator& comm);

}  // namespace lockstep
