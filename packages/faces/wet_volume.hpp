#pragma once
#include "interfaces/fluid.hpp"
#include "interfaces/liquid.hpp"

namespace lockstep {

/// The volume of liquid in the dual cell of a mixed face [m^dim]: below the free surface and
/// outside of closed solids (with `whole_cell` in them as well); where a shell parts liquid from
/// air, on the wet side of the shell. May be negative by the volume of what overlaps. Local.
template <int dim>
double wet_volume(const ControlVolume<dim>& volume, const SurfaceSnapshot<dim>& surface,
                  bool whole_cell, const LiquidFluid<dim>& liquid);

}  // namespace lockstep
