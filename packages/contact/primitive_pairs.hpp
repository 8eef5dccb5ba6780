#pragma once
#include <functional>
#include <vector>

#include "contact/contact_shapes.hpp"
#include "contact/continuous_collision.hpp"

namespace lockstep {

/// Two primitives without a common vertex, of two solids or of one and the same.
template <int dim>
struct PrimitivePair {
  PrimitiveKind kind = PrimitiveKind::vertex_simplex;
  int solid = -1, other = -1;            ///< of the first and of the second primitive
  int simplex = -1, other_simplex = -1;  ///< that hold them
  std::array<int, dim + 1> vertices{};   ///< in the order of `PrimitivePoints`
};

/// Called with all pairs of one first primitive.
template <int dim>
using UsePrimitivePairs = std::function<void(const std::vector<PrimitivePair<dim>>&)>;

/// Goes through all pairs of primitives of two solids (or of one with itself) whose boxes, the
/// union of those of their vertices, come closer than `margin` in every direction; what contact
/// cannot move is left out. By a tree of boxes. The order does not depend on the ranks. Local.
template <int dim>
void for_each_primitive(const ContactShapes<dim>& shapes, const std::vector<Box<dim>>& vertex_boxes,
                        double margin, int solid, int other, const UsePrimitivePairs<dim>& use);

template <int dim>
PrimitivePoints<dim> points_of(const PrimitivePair<dim>& pair,
                               const std::vector<Point<dim>>& vertices) {
  PrimitivePoints<dim> points;
  for (int k = 0; k <= dim; ++k)
    points[k] = vertices[pair.vertices[k]];
  return points;
}

/// The points of both surfaces that these weights mean.
template <int dim>
std::array<SurfacePoint<dim>, 2> surface_points(const ContactShapes<dim>& shapes,
                                                const PrimitivePair<dim>& pair,
                                                const PrimitiveWeights<dim>& weights);

}  // namespace lockstep
