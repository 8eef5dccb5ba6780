#pragma once
#include "liquid/common/cell_groups.hpp"
#include "liquid/fractions/fraction_transport.hpp"

namespace lockstep {

/// Liquid in cells less than half full that touch no other liquid has no pressure, and what is not
/// quite full and touches no void is a void that no pressure closes: both are taken out of the
/// flagged owned tiles, and what that changes is owed. Sets the halo of width 1 of the fractions.
/// Collective.
template <int dim>
void remove_crumbs(const MacDomain<dim>& domain, const SolidCells<dim>& solids,
                   const std::vector<char>& tiles, Fractions& fractions);

/// What bodies have got back.
struct Repayment {
  int n_bodies = 0;
  double paid = 0;  ///< in amounts [cells]
};

/// Each body of liquid takes what is owed beside it into the cells of its surface, or gives it from
/// there, but no more than that its surface moves by `largest_shift` [cells]; what is owed where no
/// body is near is shared by all in the same closed space. The rest goes on to be owed. phi and
/// fractions on the halo of width 1, which is set on return. Collective.
template <int dim>
Repayment pay_back(const MacDomain<dim>& domain, const SolidCells<dim>& solids,
                   const CellField& phi, double largest_shift, Fractions& fractions);

/// What is in cells of owned tiles that are about to go, and owed to them, is owed to the bodies in
/// the same closed space, on the tiles that stay, in proportion to their liquid. Returns what finds
/// none [cells], over all ranks. Collective.
template <int dim>
double leave_tiles(const MacDomain<dim>& domain, const SolidCells<dim>& solids,
                   const std::vector<int>& tiles, Fractions& fractions);

}  // namespace lockstep
