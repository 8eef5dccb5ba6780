#pragma once
#include <string>
#include <utility>
#include <vector>

#include "interfaces/prescribed_flux.hpp"
#include "staggered/state/mac_geometry.hpp"

namespace lockstep {

/// See FluidDiscretization::side_fluxes. Local.
template <int dim>
std::vector<PrescribedFlux> fluxes_of_sides(const MacDomain<dim>& domain,
                                            const MacGeometry<dim>& geometry, double time);
/// Notes on each inflow as the grid has it, title and text. Collective.
template <int dim>
std::vector<std::pair<std::string, std::string>> notes_of_inflows(const MacDomain<dim>& domain,
                                                                  const MacGeometry<dim>& geometry);

}  // namespace lockstep
