#pragma once
#include <array>
#include <vector>

#include "contact/search/continuous_collision.hpp"

namespace lockstep {

/// Two primitives without a common vertex, of two solids or of one and the same.
template <int dim>
struct PrimitivePair {
  PrimitiveKind kind = PrimitiveKind::vertex_simplex;
  int solid = -1, other = -1;            ///< solids of the first and of the second primitive
  int simplex = -1, other_simplex = -1;  ///< simplices that hold them
  std::array<int, dim + 1> vertices{};   ///< in the order of `PrimitivePoints`
};

template <int dim>
PrimitivePoints<dim> points_of(const PrimitivePair<dim>& pair,
                               const std::vector<Point<dim>>& vertices) {
  PrimitivePoints<dim> points;
  for (int k = 0; k <= dim; ++k)
    points[k] = vertices[pair.vertices[k]];
  return points;
}

}  // namespace lockstep
