#pragma once
#include <vector>

#include "geometry/surface_snapshot.hpp"
#include "interfaces/momentum.hpp"

namespace lockstep {

/// An impulse on a surface, as of a drop that hits it.
template <int dim>
struct SurfaceImpulse {
  SurfacePoint<dim> point;                  ///< point of a snapshot, which names the solid
  Point<dim> place = Point<dim>::Zero();    ///< where it acts [m]
  Point<dim> impulse = Point<dim>::Zero();  ///< [kg m/s]
};

/// Impulses of the fluid on solids in a step, place by place.
template <int dim>
struct SurfaceForces {
  /// Pressure, friction, lumped fluid and drops, at their solid's own place; points have simplices
  /// of `SolidSystem::surface`. This rank's part.
  std::vector<SurfaceImpulse<dim>> at_places;
  /// The hydrostatic correction, known for each whole solid alone; by solid, angular about the
  /// origin. Global.
  std::vector<Momentum<dim>> of_whole;

  SurfaceForces& operator+=(const SurfaceForces& other) {
    at_places.insert(at_places.end(), other.at_places.begin(), other.at_places.end());
    add_each(other.of_whole, of_whole);
    return *this;
  }
};

}  // namespace lockstep
