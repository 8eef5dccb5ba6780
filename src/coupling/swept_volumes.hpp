#pragma once
#include <vector>

#include "coupling/solid_system.hpp"
#include "interfaces/coupling.hpp"

namespace lockstep {

/// How much volume soft solids should sweep per time [m^dim/s], by model and solid; nan: as they
/// like. Empty if there is none to be told.
using SweptRates = std::vector<std::vector<double>>;

/// Those of soft solids that bound closed regions, whose fluid has nowhere to go. Bodies: what
/// their velocities say, N V. Shells: what these push out of the cells of the region that they
/// close, B V; with row 1 of Eq. 16 that is what flows in, to the tolerance of the solver. Where a
/// shell shares faces with a rigid or prescribed body, the latter's part, which it cannot sweep, is
/// the shell's. Follows a solve with this geometry. Collective.
template <int dim>
SweptRates swept_rates(const FluidDiscretization<dim>& fluid, const SolidSystem<dim>& solids,
                       const Coupling<dim>& coupling, const Vector& velocity);

/// Those of closed bodies alone, or of shells. Local.
template <int dim>
SweptRates rates_of_kind(const SweptRates& rates, const SolidSystem<dim>& solids, bool closed);

/// Changes velocities that are about to move the positions by dt so that the surfaces sweep that.
/// Collective.
template <int dim>
void sweep_volumes(const SweptRates& rates, const SolidSystem<dim>& solids, double dt,
                   Vector& velocity);

}  // namespace lockstep
