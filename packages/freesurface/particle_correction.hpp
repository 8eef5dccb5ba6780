#pragma once
#include "freesurface/particles.hpp"
#include "freesurface/phi_lookup.hpp"

namespace lockstep {

/// Corrects phi by the particles that are farther on the other side of the surface than their
/// radius: each is the distance to its ball at the cells around that see it; of the largest for one
/// side and the smallest for the other, the one nearer to zero counts. `phi` on the halo of width
/// 1, which is set on return. Collective.
template <int dim>
void correct_by_particles(const MacDomain<dim>& domain, const SolidCells<dim>& solids,
                          KeptSurface<dim>& kept, const ParticleTiles<dim>& tiles, CellField& phi);

/// Takes those of a side out of the flagged owned cells. Local.
template <int dim>
void remove_particles(int side, const std::vector<char>& cells, ParticleTiles<dim>& tiles);

}  // namespace lockstep
