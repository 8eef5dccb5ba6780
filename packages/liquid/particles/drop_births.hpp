#pragma once
#include "liquid/common/phi_lookup.hpp"
#include "liquid/drops/drops.hpp"
#include "liquid/particles/particles.hpp"
#include "transport/transport_frame.hpp"

namespace lockstep {

/// Takes out the particles of the liquid that no wet cell shows: of the centres around that see
/// them none is wet. Returns them as drops of no volume with the velocity of the frame, and their
/// cells. phi is set on the halo of width 1. Local.
template <int dim>
std::vector<Drop<dim>> take_lone_particles(const PhiAmongSolids<dim>& known,
                                           const TransportFrame<dim>& frame,
                                           ParticleTiles<dim>& tiles, std::vector<int>& cells);

}  // namespace lockstep
