#pragma once
#include "liquid/common/solid_cells.hpp"

namespace lockstep {

/// True if a cell lies at a side of the domain through which liquid may leave.
template <int dim>
bool at_open_side(const MacDomain<dim>& domain, int cell);

/// Fills air components of at most `most_cells` cells that liquid touches: one whose pressure is
/// held would drain the liquid around it for ever. Components at an open side stay, and so does one
/// that solids alone surround, and the last ones of a closed space: there they are the room that
/// the liquid leaves, and without them it would have no surface to give its volume back. `phi` on
/// the halo of width 1, which is set on return. Returns the owned cells filled. Collective.
template <int dim>
std::vector<int> fill_cavities(const MacDomain<dim>& domain, const SolidCells<dim>& solids,
                               int most_cells, CellField& phi);

}  // namespace lockstep
