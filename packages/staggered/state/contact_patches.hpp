#pragma once
#include "staggered/state/mac_geometry.hpp"

namespace lockstep {

/// Finds the faces between a cell of a closed solid (solid_of_cell) and a wall, or a cell of
/// another closed solid: contact patches, in which no cell has a pressure. Appends their control
/// volumes, one for each solid, to the coupled ones, and sets `contact_patches`.
///
/// Without them a closed solid's rows of B do not sum to zero: closed fluid holds it fast at a
/// wall, and a free surface rises with it. Where a solid goes through the wall there is no patch:
/// it displaces fluid as it comes in. Collective.
template <int dim>
void add_contact_patches(const MacDomain<dim>& domain, MacGeometry<dim>& geometry);

}  // namespace lockstep
