#pragma once
#include <vector>

#include "interfaces/fluid.hpp"
#include "liquid/fractions/fraction_transport.hpp"
#include "transport/nearby_surface.hpp"

namespace lockstep {

/// The part of each stored cell that closed solids leave; empty without a surface. Collective.
template <int dim>
CellField open_parts(const MacDomain<dim>& domain, const SolidCells<dim>& solids);

/// What is owed to cells that closed solids hold goes to the fluid cells beside them. Collective.
template <int dim>
void bring_out_of_solids(const MacDomain<dim>& domain, const SolidCells<dim>& solids,
                         Fractions& fractions);
/// Liquid that a surface takes along, of an owned cell [cells].
struct TakenLiquid {
  int cell = 0;
  double liquid = 0, owed = 0;
};
/// The liquid of cells that are about to leave their side of a surface, and what they are owed,
/// become what their neighbours on that side are owed; they are empty then. `leaves`: of stored
/// cells, owned ones set; `solids` at the time before. Returns what finds no neighbour, by owned
/// cell [cells]. Collective.
template <int dim>
std::vector<TakenLiquid> give_up_cells(const MacDomain<dim>& domain, const SolidCells<dim>& solids,
                                       std::vector<char>& leaves, Fractions& fractions);
/// What a surface took along as a whole, as a bag that moved over more than its size, goes to where
/// the nearest point of the surface has gone with it, on whichever rank that is. `taken` is this
/// rank's; all of it goes to all ranks. `solids` and `fractions` at the time after; the halo of
/// width 1 of the fractions is set. Returns what finds no place [cells], over all ranks.
/// Collective.
template <int dim>
double take_along(const MacDomain<dim>& domain, const SolidCells<dim>& solids,
                  const MovingSurface<dim>& surface, const NearbySurface<dim>& after, double dt,
                  const std::vector<TakenLiquid>& taken, Fractions& fractions);

}  // namespace lockstep
