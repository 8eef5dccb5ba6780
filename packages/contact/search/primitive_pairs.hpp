#pragma once
#include <functional>
#include <memory>
#include <vector>

#include "contact/bodies/contact_shapes.hpp"
#include "contact/search/approach.hpp"
#include "contact/search/primitive_pair.hpp"
#include "geometry/box_tree.hpp"

namespace lockstep {

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

  const ContactShapes<dim>& shapes() const { return shapes_; }
  /// Goes through all pairs of primitives of two solids (or of one with itself) whose boxes come
  /// closer than `margin` in every direction; what contact cannot move is left out. The order does
  /// not depend on the ranks.
  void for_each(double margin, int solid, int other, const UsePrimitivePairs<dim>& use);
  /// Goes through the pairs of one solid with itself that its motion may bring to `thickness`:
  /// pairs of edges of which it rules that out, and vertices of which it does so with all simplices
  /// that no edge connects with them, are left out. The vertices' boxes must hold their points
  /// alone.
  void for_each_closing(double margin, int solid, const Approach<dim>& approach, double thickness,
                        const UsePrimitivePairs<dim>& use);

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
  std::vector<std::unique_ptr<const Trees>>
      trees_;  ///< trees of each solid; null: not asked for yet
};

/// True if an edge of their mesh leads from one to the other.
template <int dim>
bool are_neighbours(const ContactTopology<dim>& topology, const PrimitivePair<dim>& pair);

/// The points of both surfaces that these weights mean.
template <int dim>
std::array<SurfacePoint<dim>, 2> surface_points(const ContactShapes<dim>& shapes,
                                                const PrimitivePair<dim>& pair,
                                                const PrimitiveWeights<dim>& weights);

}  // namespace lockstep
