#pragma once
#include "liquid/particles/particles.hpp"
#include "output/checkpoint.hpp"
#include "staggered/domain/mac_domain.hpp"

namespace lockstep {

/// All particles, and whether cells were in their band, under fluid/interface_particles; the same
/// file on any number of ranks up to the order within a cell. Collective.
template <int dim>
void save_particles(const MacDomain<dim>& domain, const ParticleTiles<dim>& tiles,
                    const std::vector<char>& in_band, CheckpointWriter& checkpoint);
template <int dim>
void load_particles(const MacDomain<dim>& domain, const CheckpointReader& checkpoint,
                    ParticleTiles<dim>& tiles, std::vector<char>& in_band);

}  // namespace lockstep
