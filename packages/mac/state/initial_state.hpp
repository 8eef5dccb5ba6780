#pragma once
#include "parameters/parameter_list.hpp"
#include "staggered/domain/mac_domain.hpp"

namespace lockstep {

/// Declares the typed list "Initial State" in the fluid's list.
template <int dim>
void declare_initial_state(ParameterList& fluid);

/// The velocity of the list "Initial State" at all stored faces. Local.
template <int dim>
FaceField<dim> initial_velocity(const TiledGrid<dim>& grid, const ParameterList& initial_state);

}  // namespace lockstep
