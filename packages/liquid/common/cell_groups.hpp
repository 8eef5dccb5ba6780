#pragma once
#include <vector>

#include "liquid/common/solid_cells.hpp"

namespace lockstep {

/// Cells that hang together, over all ranks.
struct CellGroups {
  std::vector<int>
      of_cell;  ///< group of each cell that is owned or in the halo of width 1; -1: no member
  int n = 0;
};

/// Groups of fluid cells among the members, joined through their faces where no surface comes
/// between their centres. Numbered by the smallest lattice number in each, so that any number of
/// ranks finds the same. `is_member`: of stored cells, its halo set. Collective.
template <int dim>
CellGroups find_groups(const MacDomain<dim>& domain, const SolidCells<dim>& solids,
                       const std::vector<char>& is_member);

/// Finds the closed spaces: components of all cells that are not solid, kept apart by surfaces of
/// solids. One space without surfaces; the space beyond the stored cells is open. Kept with the
/// solids once it is found. Collective.
template <int dim>
const CellGroups& find_closed_spaces(const MacDomain<dim>& domain, const SolidCells<dim>& solids);

/// Spreads labels >= 0 from visible neighbours over `layers` of fluid cells that have none, as far
/// as |phi| is not much larger than the layers' depth; the neighbour nearest to the surface counts,
/// whatever the axes' order. `phi` on the halo of width 1. Collective.
template <int dim>
void spread_labels(const MacDomain<dim>& domain, const SolidCells<dim>& solids,
                   const CellField& phi, int layers, std::vector<int>& label);

}  // namespace lockstep
