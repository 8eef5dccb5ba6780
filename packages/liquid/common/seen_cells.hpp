#pragma once
#include <vector>

#include "staggered/domain/mac_domain.hpp"
#include "transport/nearby_surface.hpp"

namespace lockstep {

/// The shortest way from one point to another, across periodic sides too [m].
template <int dim>
Point<dim> way_between(const MacDomain<dim>& domain, const Point<dim>& from, const Point<dim>& to);

/// Owned cells of the domain around a point [m], at most 2^dim of them, whose centres it sees: no
/// surface is between. A point that is nearer to a thin wall than half a cell may lie in a cell
/// whose centre is beyond the wall; that one is not among them.
template <int dim>
std::vector<int> cells_seen_from(const Point<dim>& point, const MacDomain<dim>& domain,
                                 const NearbySurface<dim>& surface);

}  // namespace lockstep
