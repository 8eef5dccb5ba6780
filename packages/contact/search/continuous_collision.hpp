#pragma once
#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "base/types.hpp"

namespace lockstep {

/// Roots of c[0] + c[1] t + c[2] t^2 + c[3] t^3 in [0, 1], ascending. A double root counts once;
/// none if all coefficients vanish.
std::vector<double> roots_in_unit_interval(const std::array<double, 4>& c);

/// Two primitives of surfaces that can meet: a vertex and the dim corners of a simplex, or, in 3D,
/// the two ends of an edge and the two ends of another.
enum class PrimitiveKind { vertex_simplex, edge_edge };

template <int dim>
using PrimitivePoints = std::array<Point<dim>, dim + 1>;
/// The first primitive's point minus that of the second is sum_k weight_k x_k.
template <int dim>
using PrimitiveWeights = Eigen::Matrix<double, dim + 1, 1>;

template <int dim>
Point<dim> weighted(const PrimitiveWeights<dim>& weights, const PrimitivePoints<dim>& points) {
  Point<dim> sum = Point<dim>::Zero();
  for (int k = 0; k <= dim; ++k)
    sum += weights[k] * points[k];
  return sum;
}

/// The closest points of two primitives. For edges that are parallel or whose closest points are
/// their ends nothing: vertices see that.
template <int dim>
struct ClosestPrimitives {
  PrimitiveWeights<dim> weights = PrimitiveWeights<dim>::Zero();
  double distance = 0;    ///< [m]
  bool interior = false;  ///< the point of the simplex is not on its facet
};
template <int dim>
std::optional<ClosestPrimitives<dim>> closest_primitives(PrimitiveKind kind,
                                                         const PrimitivePoints<dim>& points);

/// First meeting of two primitives whose points move linearly.
template <int dim>
struct Impact {
  double time = 0;  ///< part of the motion [0, 1]
  PrimitiveWeights<dim> weights = PrimitiveWeights<dim>::Zero();
  Point<dim> normal =
      Point<dim>::Zero();  ///< normal of the second primitive, to the first one's side
};
/// The side of the second primitive on which the first one is, where they lie on each other at the
/// start: a direction, or zero if nothing tells.
template <int dim>
using SideAtStart =
    std::function<Point<dim>(const PrimitiveWeights<dim>&, const Point<dim>& normal)>;
/// After Bridson et al. 2002: the points are coplanar (2D: collinear) at roots of a cubic (2D:
/// quadratic) in time. Motion inside one plane is not an impact. Primitives that lie on each other
/// at the start meet at once if they go to the other side; without `side` they do not meet.
template <int dim>
std::optional<Impact<dim>> first_impact(PrimitiveKind kind, const PrimitivePoints<dim>& before,
                                        const PrimitivePoints<dim>& after,
                                        const SideAtStart<dim>& side = {});

}  // namespace lockstep
