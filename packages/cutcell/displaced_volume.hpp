#pragma once
#include <vector>

#include "coupling/solid_system.hpp"
#include "cutcell/flux_shares.hpp"

namespace lockstep {

/// The generalized force per unit of acceleration along one axis [kg], as entries of the solid map.
struct AxisForce {
  int axis = 0;
  std::vector<GlobalIndex> dofs;
  std::vector<double> values;
};

/// On one axis the pressure of a fluid at rest lifts the volume V sum (1 - alpha_f) of a body, not
/// quite its own; and it lifts it at another place. The differences, for every closed dynamic solid
/// and axis: times gravity and the density of the fluid, they are the force that the pressure gives
/// too much, less the fluid lumped on it (design: the flux form). Axes along which a body reaches a
/// wall are left out: there it is not lifted. Every rank gets all. Collective.
template <int dim>
std::vector<AxisForce> displaced_excess(const std::vector<ControlVolume<dim>>& volumes,
                                        const std::vector<FaceShares<dim>>& shares,
                                        const std::vector<double>& lumped_masses,
                                        const SolidSystem<dim>& solids,
                                        const SurfaceSnapshot<dim>& surface, double density);

}  // namespace lockstep
