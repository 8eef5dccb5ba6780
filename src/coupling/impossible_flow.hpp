#pragma once
#include <string>
#include <vector>

#include "coupling/solid_system.hpp"
#include "interfaces/prescribed_flux.hpp"
#include "linear/null_space.hpp"

namespace lockstep {

/// Prescribed velocities at the boundary of the fluid. Every rank names the same, in the same
/// order.
struct PrescribedFluxes {
  std::vector<PrescribedFlux> sides;   ///< exact
  std::vector<PrescribedFlux> solids;  ///< as the grid sees them
};

/// A sentence if something prescribed changes the volume of fluid that is closed in and cannot
/// change it, with the names and the rates; empty if not. The null vectors are those of the coupled
/// system: regions without an open side, whose volume no free solid can change.
///
/// Solids are voxels or clipped polygons, so that not all that should cancel does: a solid is taken
/// to change a volume if more than half of all that its faces push, in one direction and the other,
/// is left in the sum, which is all of it for a piston and next to nothing for whatever turns or
/// passes by; and then up to a tenth of it may be balanced by others not quite. Regions of no more
/// cells than `smallest_region`, which the grid makes, are ignored, and so are changes of no more
/// than `negligible` [m^dim/s]. Collective.
std::string impossible_flow(const NullSpace& null_space, const PrescribedFluxes& fluxes,
                            GlobalIndex smallest_region, double negligible,
                            const std::string& unit);

/// All closed fluid as one null vector, if nothing but a squeezed soft body could change its volume
/// as a whole; else a space without vectors. A shell or a rigid solid that has open fluid or gas at
/// its other side can change it, and so can a soft body that touches open fluid or reaches more
/// than `cell` [m] out of the domain. `pressure`: the regions without an open side;
/// `coupling_transposed`: the (solid dofs x pressures) matrix at the same geometry. Collective.
template <int dim>
NullSpace fluid_that_squeezes_solids(const NullSpace& pressure,
                                     const CrsMatrix& coupling_transposed,
                                     const SolidSystem<dim>& solids,
                                     const SurfaceSnapshot<dim>& surface, const Box<dim>& domain,
                                     double cell);

}  // namespace lockstep
