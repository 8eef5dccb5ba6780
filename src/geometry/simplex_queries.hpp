#pragma once
#include <array>
#include <optional>

#include "base/types.hpp"

namespace lockstep {

/// Point of one segment or triangle that is closest to x; degenerate simplices are allowed.
template <int dim>
struct ClosestOnSimplex {
  Barycentric<dim> barycentric = Barycentric<dim>::Zero();
  Point<dim> position = Point<dim>::Zero();
  double distance = 0;  ///< [m]
};
template <int dim>
ClosestOnSimplex<dim> closest_on_simplex(const std::array<Point<dim>, dim>& corners,
                                         const Point<dim>& x);

/// First point of a simplex on the segment a -> b (of non-zero length).
template <int dim>
struct SimplexHit {
  double fraction = 0;  ///< 0 at a, 1 at b
  Barycentric<dim> barycentric = Barycentric<dim>::Zero();
  Point<dim> position = Point<dim>::Zero();
};
/// Ends and facet are included, and widened by `tolerance` [m] plus 1e-12 of the size, so that a
/// segment through an edge hits at least one of the two simplices. A segment inside the plane of
/// the simplex meets it at its first common point.
template <int dim>
std::optional<SimplexHit<dim>> hit_simplex(const std::array<Point<dim>, dim>& corners,
                                           const Point<dim>& a, const Point<dim>& b,
                                           double tolerance);

}  // namespace lockstep
