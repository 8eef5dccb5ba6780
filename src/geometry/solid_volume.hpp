#pragma once
#include "geometry/surface_snapshot.hpp"

namespace lockstep {

/// Volume [m^dim] of the closed solids inside `box`, exact for their polyhedra: the flux of a
/// vector field through the surface that is clipped to the box and to the column between it and the
/// nearest side of the solid's bounds. Costs O(simplices that touch the column); meant for boxes
/// near the surface. Overlapping solids are counted each, but never beyond the box volume. Zero for
/// shells.
template <int dim>
double solid_volume_in_box(const SurfaceSnapshot<dim>& surface, const Box<dim>& box);

/// Returns the volume of one closed solid in a box [m^dim].
template <int dim>
double solid_volume_in_box(const SurfaceSnapshot<dim>& surface, const Box<dim>& box, int solid);

/// Part of a solid in a box.
template <int dim>
struct PartOfSolid {
  double volume = 0;                         ///< [m^dim]
  Point<dim> centroid = Point<dim>::Zero();  ///< [m]; of the whole solid if the volume is zero
};

/// The part of a closed solid inside `box`, exact for its polyhedron. Costs nothing more than the
/// volume of the whole where the box holds it. Local.
template <int dim>
PartOfSolid<dim> part_of_solid(const SurfaceSnapshot<dim>& surface, int solid, const Box<dim>& box);

/// The part of a closed solid inside `box` and below a plane, where up . x <= level for a unit
/// vector `up`. Exact, unless both a side of the box and a plane that is not parallel to one cut
/// the solid: then the box is left out. Local.
template <int dim>
PartOfSolid<dim> part_below(const SurfaceSnapshot<dim>& surface, int solid, const Box<dim>& box,
                            const Point<dim>& up, double level);

}  // namespace lockstep
