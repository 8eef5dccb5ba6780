#pragma once
#include <vector>

#include "cutcell/flux_shares.hpp"
#include "faces/axis_force.hpp"
#include "interfaces/liquid.hpp"

namespace lockstep {

/// Of every closed solid and axis; but not along axes on which a body reaches a wall, where it is
/// not lifted. Of a body that sticks out of `domain` only the part inside counts, of one that
/// sticks out of the water, by `wet` (empty: the fluid has no surface), what is below the plane of
/// the free surface around it, whichever way that lies; `gravity` is what the excess will be
/// weighed by. Every rank gets all. Collective.
template <int dim>
std::vector<DisplacedExcess<dim>> displaced_excess(
    const std::vector<ControlVolume<dim>>& volumes, const std::vector<FaceShares<dim>>& shares,
    const std::vector<double>& lumped_masses, const SurfaceSnapshot<dim>& surface, double density,
    const Box<dim>& domain, const Point<dim>& gravity, const std::vector<WetBody<dim>>& wet,
    const Communicator& comm);

}  // namespace lockstep
