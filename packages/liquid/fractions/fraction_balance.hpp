#pragma once
#include "liquid/common/cell_groups.hpp"
#include "liquid/fractions/fraction_transport.hpp"

namespace lockstep {

/// Removes fragments from the flagged owned tiles: liquid in cells less than half full that touch
/// no other liquid, which has no pressure, and air in cells that are not quite full and touch no
/// air, which no pressure closes. The change is a volume defect. Sets the halo of width 1 of the
/// fractions. Collective.
template <int dim>
void remove_fragments(const MacDomain<dim>& domain, const SolidCells<dim>& solids,
                      const std::vector<char>& tiles, Fractions& fractions);

/// Result of a redistribution of volume defects.
struct Repayment {
  int n_bodies = 0;
  double paid = 0;  ///< in amounts [cells]
};

/// Redistributes volume defects: each liquid component takes the defects beside it into the cells
/// of its surface, or gives them from there, but no more than moves its surface by `largest_shift`
/// [cells]; defects with no component near are shared by all in the same closed space. The rest
/// remains a defect. phi and fractions on the halo of width 1, which is set on return. Collective.
template <int dim>
Repayment pay_back(const MacDomain<dim>& domain, const SolidCells<dim>& solids,
                   const CellField& phi, double largest_shift, Fractions& fractions);

/// Adds the liquid and the defects in cells of owned tiles that are about to go to the defects of
/// the components in the same closed space, on the tiles that stay, in proportion to their liquid.
/// Returns the rest that finds none [cells], over all ranks. Collective.
template <int dim>
double leave_tiles(const MacDomain<dim>& domain, const SolidCells<dim>& solids,
                   const std::vector<int>& tiles, Fractions& fractions);

}  // namespace lockstep
