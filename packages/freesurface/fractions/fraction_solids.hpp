#pragma once
#include "freesurface/fractions/fraction_transport.hpp"

namespace lockstep {

/// The part of each stored cell that closed solids leave; empty without a surface. Collective.
template <int dim>
CellField open_parts(const MacDomain<dim>& domain, const SolidCells<dim>& solids);

/// What is owed to cells that closed solids hold goes to the fluid cells beside them. Collective.
template <int dim>
void bring_out_of_solids(const MacDomain<dim>& domain, const SolidCells<dim>& solids,
                         Fractions& fractions);
/// The liquid of cells that are about to leave their side of a surface, and what they are owed,
/// become what their neighbours on that side are owed; they are empty then. `leaves`: of stored
/// cells, owned ones set; `solids` at the time before. Returns what finds no neighbour, of this
/// rank [cells]. Collective.
template <int dim>
double give_up_cells(const MacDomain<dim>& domain, const SolidCells<dim>& solids,
                     std::vector<char>& leaves, Fractions& fractions);

}  // namespace lockstep
