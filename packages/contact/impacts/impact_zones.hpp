#pragma once
#include <vector>

#include "contact/bodies/inverse_mass.hpp"
#include "contact/impacts/impacts.hpp"

namespace lockstep {

/// Result of `join_impact_zones`.
template <int dim>
struct ZonedMotion {
  int n_left = 0;  ///< impacts, where prescribed solids or locked nodes squeeze others
  /// Impacts of zones with rigid solids or locked nodes. These zones go where their momentum alone
  /// would not take them, so what they have of it must change, too: see `held_contacts`.
  std::vector<FoundImpact<dim>> held_back;
};

/// The fail-safe of the positions (rigid impact zones, Provot 1997, Bridson et al. 2002): vertices
/// that would still pass through each other are joined into zones that move rigidly, with the
/// linear and angular momentum that their nodes had, until nothing crosses. A zone that touches one
/// rigid solid, or nodes attached to one, goes with it (which does not feel it: this is for
/// positions, whose velocities are discarded); one with locked nodes moves as they do along the
/// axes that are locked. With several rigid solids it moves as those that are prescribed do, in the
/// mean; if none is, with the momentum of all. Bodies that joints keep from that stay where they
/// are, and all their zone with them. `unheld`: see `SurfacePath`. Changes `velocity` (by id).
/// Local; the same on all ranks.
template <int dim>
ZonedMotion<dim> join_impact_zones(const SolidSystem<dim>& system, const ContactShapes<dim>& shapes,
                                   const InverseMass& inverse_mass, double dt,
                                   std::vector<double>& velocity,
                                   const std::vector<Point<dim>>& unheld = {});

}  // namespace lockstep
