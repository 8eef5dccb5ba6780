#pragma once
#include <vector>

#include "coupling/solid_system.hpp"
#include "interfaces/coupling.hpp"

namespace lockstep {

/// Volume that soft solids should sweep per time [m^dim/s], by model and solid; nan: any volume.
/// Empty if no solid has a given volume.
using SweptRates = std::vector<std::vector<double>>;

/// Returns the rates of soft solids that bound closed regions, whose fluid has nowhere to go. A
/// body sweeps what its velocities say, N V. A shell sweeps what these push out of the cells of the
/// region that it closes, B V, which by row 1 of Eq. 16 is the inflow, to the tolerance of the
/// solver. Where a shell shares faces with a rigid or prescribed body, the latter's part, which the
/// body cannot sweep, is the shell's. Follows a solve with this geometry. Collective.
template <int dim>
SweptRates swept_rates(const FluidDiscretization<dim>& fluid, const SolidSystem<dim>& solids,
                       const Coupling<dim>& coupling, const Vector& velocity);

/// Returns the rates of closed bodies alone, or of shells alone. Local.
template <int dim>
SweptRates rates_of_kind(const SweptRates& rates, const SolidSystem<dim>& solids, bool closed);

/// Changes velocities that are about to move the positions by dt so that the surfaces sweep these
/// volumes. Collective.
template <int dim>
void sweep_volumes(const SweptRates& rates, const SolidSystem<dim>& solids, double dt,
                   Vector& velocity);

}  // namespace lockstep
