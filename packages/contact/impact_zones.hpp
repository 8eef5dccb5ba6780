#pragma once
#include <vector>

#include "contact/impacts.hpp"
#include "contact/inverse_mass.hpp"

namespace lockstep {

/// The fail-safe of the positions (rigid impact zones, Provot 1997, Bridson et al. 2002): vertices
/// that would still pass through each other are joined into zones that move rigidly, with the
/// linear and angular momentum that their nodes had, until nothing crosses. A zone that touches one
/// rigid solid, or nodes attached to one, goes with it (which does not feel it: this is for
/// positions, whose velocities are discarded); one with locked nodes moves as they do along the
/// axes that are locked. Where these disagree, nodes and dynamic bodies of the zone stay. Changes
/// `velocity` (by id). Returns the impacts that are left, which needs prescribed solids that
/// squeeze others. Local; the same on all ranks.
template <int dim>
int join_impact_zones(const SolidSystem<dim>& system, const ContactShapes<dim>& shapes,
                      const InverseMass& inverse_mass, bool self, double dt,
                      std::vector<double>& velocity);

}  // namespace lockstep
