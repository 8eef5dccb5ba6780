#pragma once
#include <vector>

#include "faces/surface_shares.hpp"
#include "interfaces/liquid.hpp"

namespace lockstep {

/// M_F [kg] of each coupled control volume: density times the dual cell minus the solids in it,
/// never negative; with `whole_cell` density times the dual cell. Of a `liquid` (or null) only what
/// is below its free surface, and where a shell parts it from the air, on its own side.
template <int dim>
std::vector<double> fluid_masses(const std::vector<ControlVolume<dim>>& volumes,
                                 const SurfaceSnapshot<dim>& surface, bool whole_cell,
                                 const LiquidFluid<dim>* liquid);

}  // namespace lockstep
