#pragma once
#include <vector>

#include "cutcell/flux_shares.hpp"
#include "faces/axis_force.hpp"
#include "interfaces/liquid.hpp"

namespace lockstep {

/// Returns the excess of displaced volume of every closed solid along every axis, but not along
/// axes on which a body reaches a wall, where it is not lifted. Of a body that sticks out of
/// `domain` only the part inside counts; of one that sticks out of the water, by `wet` (empty: the
/// fluid has no surface), the part below the plane of the free surface around it, whichever way
/// that lies. `gravity` is the acceleration that will multiply the excess. Every rank gets all.
/// Collective.
template <int dim>
std::vector<DisplacedExcess<dim>> displaced_excess(
    const std::vector<ControlVolume<dim>>& volumes, const std::vector<FaceShares<dim>>& shares,
    const std::vector<double>& lumped_masses, const SurfaceSnapshot<dim>& surface, double density,
    const Box<dim>& domain, const Point<dim>& gravity, const std::vector<WetBody<dim>>& wet,
    const Communicator& comm);

}  // namespace lockstep
