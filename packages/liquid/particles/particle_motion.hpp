#pragma once
#include "liquid/common/phi_lookup.hpp"
#include "liquid/common/volume_ledger.hpp"
#include "liquid/particles/particles.hpp"
#include "staggered/domain/mac_domain.hpp"
#include "transport/ray_halo.hpp"
#include "transport/transport_frame.hpp"

namespace lockstep {

/// Moves all particles with the flow of the frame, by the midpoint rule, to the tiles they are in
/// then. A particle that a surface of solids would pass stays on its side or is removed; one that
/// leaves through an open side is removed, too. Returns the number that surfaces have removed on
/// this rank. Collective.
template <int dim>
GlobalIndex move_particles(const MacDomain<dim>& domain, TransportFrame<dim>& frame,
                           const RayHalo<dim>& ray_halo, ParticleTiles<dim>& tiles);

/// Moves the particles near the surface along with it where a volume correction has shifted phi:
/// else they would pull it back. `phi` on the halo of width 1. Collective.
template <int dim>
void shift_particles(const MacDomain<dim>& domain, const SolidCells<dim>& solids,
                     KeptSurface<dim>& kept, const VolumeShift& shift, const CellField& phi,
                     ParticleTiles<dim>& tiles);

}  // namespace lockstep
