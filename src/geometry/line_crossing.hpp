#pragma once
#include <array>

#include "geometry/surface_snapshot.hpp"

namespace lockstep {

/// True if the line through x parallel to `axis` crosses the simplex; fills all of `crossing` but
/// its simplex. Watertight: in 3D a simplex is crossed if an odd number of its edges lies beyond x
/// along one transverse axis, each edge being decided by one expression of its end points alone, so
/// every edge of a closed surface counts twice. Half-open: a crossing exactly on the lower facet of
/// the projection counts, on the upper one it does not. Simplices parallel to the axis are not
/// crossed. No tolerances.
template <int dim>
bool cross_line(const std::array<Point<dim>, dim>& corners, int axis, const Point<dim>& x,
                Crossing<dim>& crossing);

}  // namespace lockstep
