#pragma once
#include "interfaces/coupling.hpp"
#include "parameters/registry.hpp"

namespace lockstep {

/// Registers the coupling "mixed face".
template <int dim>
void register_mixed_face(Registry<Coupling<dim>>& couplings);

}  // namespace lockstep
