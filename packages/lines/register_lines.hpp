#pragma once
#include "interfaces/registries.hpp"

namespace lockstep {

/// Registers the solid models "spring" and "mooring line", each of which holds all lines of its
/// type; the schemas in the registry are those of one.
template <int dim>
void register_lines(SolidRegistry<dim>& solids);

}  // namespace lockstep
