#pragma once
#include "base/types.hpp"

namespace lockstep {

/// A plane through a unit cell whose lower corner is the origin; the liquid is where
/// normal . x < constant. The components of the normal have the absolute sum 1.
template <int dim>
struct CellPlane {
  Point<dim> normal = Point<dim>::Zero();
  double constant = 0;
};

/// The part of the cell that is below the plane, in [0, 1].
template <int dim>
double fraction_below(const CellPlane<dim>& plane);
/// The plane with this normal, of any length but 0, that leaves `fraction` of the cell below it.
template <int dim>
CellPlane<dim> plane_of_fraction(const Point<dim>& normal, double fraction);
/// Volume of the liquid in the slab of that width (at most 1) beside the lower (0) or upper (1)
/// side normal to `axis` [cells].
template <int dim>
double liquid_in_slab(const CellPlane<dim>& plane, int axis, int side, double width);

}  // namespace lockstep
