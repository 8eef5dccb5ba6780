#pragma once
#include <vector>

#include "mac/state/mac_flow.hpp"

namespace lockstep {

struct SurfaceFrame;  // output/frames.hpp

// Momentum, energy and forces of drops that are smaller than a cell. Drops know no density.

template <int dim>
Momentum<dim> momentum_of_drops(const MacFlow<dim>& flow);  ///< this rank's part [kg m/s]
template <int dim>
double energy_of_drops(const MacFlow<dim>& flow);  ///< this rank's part [J]
/// Gives drops that have flown the velocities that the step's forces lead to; returns the change of
/// momentum, of this rank.
template <int dim>
Momentum<dim> speed_up_drops(MacFlow<dim>& flow);
/// Adds drops that have fallen into the liquid to it. Collective.
template <int dim>
void give_back_momentum(MacFlow<dim>& flow);
/// See LiquidFluid::impulses_on_solids. Collective.
template <int dim>
std::vector<SurfaceImpulse<dim>> impulses_of_drops(const MacFlow<dim>& flow);
/// Points with radii and velocities. Collective.
template <int dim>
SurfaceFrame frame_of_drops(const MacFlow<dim>& flow);

}  // namespace lockstep
