#pragma once
#include <vector>

#include "deformable/nodal_surface.hpp"

namespace lockstep {

/// The state of each body; `elastic_energy` of each [J]. Collective.
template <int dim>
std::vector<SolidState<dim>> body_states(const BodyNodes<dim>& nodes,
                                         const NodalSurface<dim>& surface,
                                         const std::vector<double>& elastic_energy);

}  // namespace lockstep
