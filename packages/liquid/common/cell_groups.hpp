#pragma once
#include <vector>

#include "liquid/common/solid_cells.hpp"

namespace lockstep {

/// Cells that hang together, over all ranks.
struct CellGroups {
  std::vector<int> of_cell;  ///< of each stored cell of the halo of width 1 or owned; -1: no member
  int n = 0;
};

/// Groups of fluid cells among the members, joined through their faces where no surface comes
/// between their centres. Numbered by the smallest lattice number in each, so that any number of
/// ranks finds the same. `is_member`: of stored cells, its halo set. Collective.
template <int dim>
CellGroups find_groups(const MacDomain<dim>& domain, const SolidCells<dim>& solids,
                       const std::vector<char>& is_member);

/// The spaces that surfaces of solids keep apart: all cells in which there may be liquid. One space
/// without surfaces; what lies beyond the cells that are stored is open. Kept with the solids, and
/// found at the first time. Collective.
template <int dim>
const CellGroups& find_closed_spaces(const MacDomain<dim>& domain, const SolidCells<dim>& solids);

/// Spreads labels >= 0 from seen neighbours over `layers` of fluid cells that have none, as far as
/// |phi| is not much more than these are deep; of several neighbours from that which is nearest to
/// the surface, whatever the axes' order. `phi` on the halo of width 1. Collective.
template <int dim>
void spread_labels(const MacDomain<dim>& domain, const SolidCells<dim>& solids,
                   const CellField& phi, int layers, std::vector<int>& label);

}  // namespace lockstep
