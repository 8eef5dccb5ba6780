#pragma once
#include <functional>
#include <memory>
#include <vector>

#include "contact/bodies/contact_shapes.hpp"
#include "contact/search/continuous_collision.hpp"
#include "geometry/box_tree.hpp"

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

/// The primitives of all solids with their boxes, the unions of those of their vertices: trees of
/// them, made for the solids that are asked for. Local.
template <int dim>
class PrimitivePairs {
 public:
  /// Boxes that hold one vertex each.
  PrimitivePairs(const ContactShapes<dim>& shapes, std::vector<Box<dim>> vertex_boxes);

  /// Goes through all pairs of primitives of two solids (or of one with itself) whose boxes come
  /// closer than `margin` in every direction; what contact cannot move is left out. The order does
  /// not depend on the ranks.
  void for_each(double margin, int solid, int other, const UsePrimitivePairs<dim>& use);

 private:
  /// Numbers in the trees count from the solid's first vertex, simplex and edge.
  struct Trees {
    Box<dim> extent;
    BoxTree<dim> vertices, simplices, edges;
  };
  const Trees& trees_of(int solid);
  Trees make_trees(int solid) const;

  const ContactShapes<dim>& shapes_;
  std::vector<Box<dim>> vertex_boxes_;
  std::vector<std::unique_ptr<const Trees>> trees_;  ///< of each solid; null: not asked for yet
};

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
