#pragma once
#include "interfaces/coupling.hpp"
#include "parameters/registry.hpp"

namespace lockstep {

/// Registers the coupling "flux".
template <int dim>
void register_flux(Registry<Coupling<dim>>& couplings);

}  // namespace lockstep
