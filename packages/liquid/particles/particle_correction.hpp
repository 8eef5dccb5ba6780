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

/// Marks with 1 the cells around particles of a side (-1: of the liquid) that see them: those
/// owned, and the halo of width 1; and as hidden the owned ones that hold a particle which none of
/// the centres around sees. `phi` on that halo. Collective.
template <int dim>
void add_cells_seen(int side, const MacDomain<dim>& domain, const SolidCells<dim>& solids,
                    KeptSurface<dim>& kept, const CellField& phi, const ParticleTiles<dim>& tiles,
                    std::vector<char>& cells, std::vector<char>& hidden);

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
