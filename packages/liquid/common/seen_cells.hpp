#pragma once
#include <string>
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

/// Likewise, of a point that a scene gives, `name`d in messages: throws InputError if it lies
/// outside of the domain or in a solid, or sees no centre. Collective.
template <int dim>
std::vector<int> cells_seen_from_given(const Point<dim>& point, const std::string& name,
                                       const MacDomain<dim>& domain,
                                       const NearbySurface<dim>& surface);

}  // namespace lockstep
