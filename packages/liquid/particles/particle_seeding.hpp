#pragma once
#include "liquid/common/phi_lookup.hpp"
#include "liquid/particles/particles.hpp"

namespace lockstep {

/// Gives each particle its distance from the surface as radius, within limits, unless it is farther
/// on the other side than its radius. Local.
template <int dim>
void set_radii(const PhiAmongSolids<dim>& known, ParticleTiles<dim>& tiles);

/// Cells that get particles.
enum class Seeding {
  new_cells,  ///< cells that have come into the band and have none
  all_cells   ///< all of the band, up to their number; surplus ones and those beyond it go
};

/// Adds particles where there are too few: each at a random place of a cell, moved along the
/// gradient of phi to a random distance on the cell's side. `step` makes the numbers random.
/// `in_band`: of owned cells, in the band the last time; set anew. phi is set on all stored cells.
/// Collective.
template <int dim>
void seed_particles(const PhiAmongSolids<dim>& known, const ParticleParameters& parameters,
                    Seeding seeding, long long step, std::vector<char>& in_band,
                    ParticleTiles<dim>& tiles);

}  // namespace lockstep
