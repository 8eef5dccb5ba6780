#pragma once
#include <string>
#include <utility>
#include <vector>

#include "interfaces/momentum.hpp"
#include "interfaces/prescribed_flux.hpp"
#include "mac/state/mac_flow.hpp"

namespace lockstep {

/// See FluidDiscretization::side_fluxes. Local.
template <int dim>
std::vector<PrescribedFlux> fluxes_of_sides(const MacDomain<dim>& domain,
                                            const MacGeometry<dim>& geometry, double time);
/// Sets the streams of sides that send waves, to bring in as much below the surface at the fluid's
/// time as their waves do. `lead`: time by which the surface goes on until then, of one that is
/// moved by fluxes: these bring in what is below it in the middle of the step, rays what is there
/// at the start [s]. Collective.
template <int dim>
void balance_waves(double lead, MacFlow<dim>& flow);
/// Pushes the owned free faces of open sides with a pressure by it at `time` over `dt` [s], as if
/// it were that of cells beyond; the pressure that is solved for is 0 there. What comes in has
/// gained its speed from rest on the way: there the pressure is less by rho u^2/2. `velocity`: that
/// before forces; along the side that of the `last` step counts. Returns the impulse on this rank's
/// fluid. Local.
template <int dim>
Momentum<dim> push_of_pressures(const MacDomain<dim>& domain, const MacGeometry<dim>& geometry,
                                double time, double dt, const FaceField<dim>& last,
                                FaceField<dim>& velocity);
/// Notes on each inflow as the grid has it, title and text. Collective.
template <int dim>
std::vector<std::pair<std::string, std::string>> notes_of_inflows(const MacDomain<dim>& domain,
                                                                  const MacGeometry<dim>& geometry);

}  // namespace lockstep
