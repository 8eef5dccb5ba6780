#pragma once
#include "liquid/common/phi_lookup.hpp"
#include "liquid/particles/particles.hpp"

namespace lockstep {

/// Corrects phi by the particles that are farther on the other side of the surface than their
/// radius: each is the distance to its ball at the cells around that see it; of the largest for one
/// side and the smallest for the other, the one nearer to zero counts. `phi` on the halo of width
/// 1, which is set on return. Collective.
template <int dim>
void correct_by_particles(const MacDomain<dim>& domain, const SolidCells<dim>& solids,
                          KeptSurface<dim>& kept, const ParticleTiles<dim>& tiles, CellField& phi);

/// Takes out the particles of air that a solid and liquid enclose: of the centres around, one at
/// least does not see them or lies in a solid, and those that do are all wet. No cell could hold
/// that air, and yet it would keep phi near zero around it, and follow the solid for good. `phi` on
/// the halo of width 1. Local.
template <int dim>
void remove_trapped_air(const MacDomain<dim>& domain, const SolidCells<dim>& solids,
                        KeptSurface<dim>& kept, const CellField& phi, ParticleTiles<dim>& tiles);

/// Removes the particles of a side from the flagged owned cells. Local.
template <int dim>
void remove_particles(int side, const std::vector<char>& cells, ParticleTiles<dim>& tiles);

}  // namespace lockstep
