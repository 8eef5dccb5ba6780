#pragma once
#include "mac/liquid/solid_cells.hpp"

namespace lockstep {

/// Continues phi into solids over `depth` cells, as a plane: each front takes what its neighbours
/// along the axes, seen from the fluid, lead to, in the mean. |phi| <= cut_off [m]. All stored
/// cells are set on return, and must be before. Collective.
template <int dim>
void continue_into_solids(const MacDomain<dim>& domain, const SolidCells<dim>& solids, int depth,
                          double cut_off, CellField& phi);

}  // namespace lockstep
