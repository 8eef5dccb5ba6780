#pragma once
#include <vector>

#include "geometry/surface_snapshot.hpp"

namespace lockstep {

/// The part of a face that lies inside one closed solid.
template <int dim>
struct ClosedPart {
  int solid = -1;
  double area = 0;                         ///< [m^(dim-1)]
  Point<dim> center = Point<dim>::Zero();  ///< its centroid [m]
};

/// The parts of a face inside each closed solid that touches it, in ascending order of the solids:
/// exact for their polyhedra up to round-off. `face` is flat along `axis`. A simplex that lies in
/// the plane of the face closes it from either side. Overlapping solids count each. Costs
/// O(simplices between the face and the nearest side of the solid's bounds). Local.
template <int dim>
std::vector<ClosedPart<dim>> closed_parts(const SurfaceSnapshot<dim>& surface, const Box<dim>& face,
                                          int axis);

/// The volumes of a dual cell inside each closed solid, as parts of its face: area is volume over
/// the length of `box` along `axis` (Batty et al. 2007). The volumes are exact for polyhedra; the
/// centroids come from four sections of the box. Local.
template <int dim>
std::vector<ClosedPart<dim>> closed_volumes(const SurfaceSnapshot<dim>& surface,
                                            const Box<dim>& box, int axis);

}  // namespace lockstep
