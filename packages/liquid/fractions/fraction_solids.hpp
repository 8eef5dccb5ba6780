#pragma once
#include <vector>

#include "liquid/common/interface_model.hpp"
#include "liquid/fractions/fraction_transport.hpp"

namespace lockstep {

/// Returns the part of each stored cell outside closed solids; empty without a surface. Collective.
template <int dim>
CellField open_parts(const MacDomain<dim>& domain, const SolidCells<dim>& solids);

/// Moves the defects of cells that closed solids hold to the fluid cells beside them. Collective.
template <int dim>
void bring_out_of_solids(const MacDomain<dim>& domain, const SolidCells<dim>& solids,
                         Fractions& fractions);
/// Liquid that a surface takes along, of an owned cell [cells].
struct TakenLiquid {
  int cell = 0;
  double liquid = 0, defect = 0;
};
/// Moves the liquid and the defects of cells that are about to leave their side of a surface to the
/// defects of their neighbours on that side; the cells are empty then. `leaves`: marks of stored
/// cells, set on owned ones; `solids` at the time before. Returns the liquid that finds no
/// neighbour, by owned cell [cells]. Collective.
template <int dim>
std::vector<TakenLiquid> give_up_cells(const MacDomain<dim>& domain, const SolidCells<dim>& solids,
                                       std::vector<char>& leaves, Fractions& fractions);
/// Moves liquid that a surface took along as a whole, as a bag that moved over more than its size,
/// to where the nearest point of the surface has gone, on whichever rank that is. `taken` is this
/// rank's; all of it goes to all ranks. `solids` and `fractions` at the time after; the halo of
/// width 1 of the fractions is set. Returns the liquid that finds no place [cells], over all ranks.
/// Collective.
template <int dim>
double take_along(const MacDomain<dim>& domain, const SolidCells<dim>& solids,
                  const InterfaceStep<dim>& step, const std::vector<TakenLiquid>& taken,
                  Fractions& fractions);

/// Adds a volume [cells], the same on all ranks, to the defects of all cells that are more than
/// half full, in proportion to their liquid. Returns it if there are none, else 0. Collective.
template <int dim>
double share_among_liquid(const MacDomain<dim>& domain, const SolidCells<dim>& solids,
                          double volume, Fractions& fractions);

}  // namespace lockstep
