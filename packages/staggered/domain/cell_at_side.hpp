#pragma once
#include "staggered/domain/mac_domain.hpp"

namespace lockstep {

/// True if a cell of the domain touches one of the sides for which is_such(side) is true.
template <int dim, typename Choice>
bool at_side(const MacDomain<dim>& domain, int cell, const Choice& is_such) {
  const Index<dim> place = domain.grid.coordinates(cell);
  for (int axis = 0; axis < dim; ++axis)
    for (int end = 0; end < 2; ++end)
      if (place[axis] == (end == 0 ? 0 : domain.grid.n_cells()[axis] - 1) &&
          is_such(domain.boundary.side(axis, end)))
        return true;
  return false;
}

}  // namespace lockstep
