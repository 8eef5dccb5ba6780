#pragma once
#include <vector>

#include "coupling/solid_system.hpp"
#include "cutcell/flux_shares.hpp"

namespace lockstep {

/// On one axis the pressure of a fluid at rest lifts the volume V sum (1 - alpha_f) of a body, not
/// quite its own; and it lifts it at another place. The difference, less the fluid lumped on the
/// body, in masses of fluid: times gravity it is the force that the pressure gives too much
/// (design: the flux form).
template <int dim>
struct DisplacedExcess {
  int solid = -1;                          ///< closed; index in the snapshot
  int axis = 0;                            ///< of the acceleration that it is weighed by
  Point<dim> center = Point<dim>::Zero();  ///< the solid's centroid [m]
  double mass = 0;                         ///< at the centroid [kg]
  Point<dim> moment = Point<dim>::Zero();  ///< of mass about the centroid, across the axis [kg m]
};

/// Of every closed solid and axis; but not along axes on which a body reaches a wall, where it is
/// not lifted. Of a body that sticks out of `domain` only the part inside counts. Every rank gets
/// all. Collective.
template <int dim>
std::vector<DisplacedExcess<dim>> displaced_excess(const std::vector<ControlVolume<dim>>& volumes,
                                                   const std::vector<FaceShares<dim>>& shares,
                                                   const std::vector<double>& lumped_masses,
                                                   const SurfaceSnapshot<dim>& surface,
                                                   double density, const Box<dim>& domain,
                                                   const Communicator& comm);

/// The generalized force per unit of acceleration along one axis [kg], as entries of the solid map.
struct AxisForce {
  int axis = 0;
  std::vector<GlobalIndex> dofs;
  std::vector<double> values;
};

/// What a dynamic solid takes: a rigid body the force and its moment, a deformable one the force,
/// over its surface.
template <int dim>
AxisForce force_of(const DisplacedExcess<dim>& excess, const SolidSystem<dim>& solids,
                   const SurfaceSnapshot<dim>& surface);

}  // namespace lockstep
