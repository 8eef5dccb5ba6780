#pragma once
#include "liquid/common/interface_model.hpp"
#include "staggered/domain/mac_domain.hpp"
#include "transport/nearby_surface.hpp"

namespace lockstep {

/// Marks the stored cells (1: dry) that can be reached from a point below the surface of a liquid,
/// cell by cell, without crossing a surface of solids: the inside of a hull. Throws InputError for
/// a point inside a solid or outside of the domain. Collective.
template <int dim>
std::vector<char> find_dry_cells(const MacDomain<dim>& domain, const SignedDistance<dim>& distance,
                                 const NearbySurface<dim>& surface,
                                 const std::vector<Point<dim>>& points);

}  // namespace lockstep
