#pragma once
#include <vector>

#include "mac/transport/nearby_surface.hpp"

namespace lockstep {

/// Owned cells of the domain around a point [m], at most 2^dim of them, whose centres it sees: no
/// surface is between. A point that is nearer to a thin wall than half a cell may lie in a cell
/// whose centre is beyond the wall; that one is not among them.
template <int dim>
std::vector<int> cells_seen_from(const Point<dim>& point, const TiledGrid<dim>& grid,
                                 const NearbySurface<dim>& surface);

}  // namespace lockstep
