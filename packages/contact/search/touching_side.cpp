#include "contact/search/touching_side.hpp"

#include <cmath>

namespace lockstep {

template <int dim>
Point<dim> touching_side(const ContactShapes<dim>& shapes, const PrimitivePair<dim>& pair,
                         const PrimitiveWeights<dim>& weights, const Point<dim>& normal,
                         const Point<dim>& motion, double negligible) {
  if (pair.solid == pair.other)
    return Point<dim>::Zero();
  const auto& solids = shapes.solids();
  // The second one's points weigh less than nothing.
  Point<dim> out = Point<dim>::Zero();
  for (int k = 0; k <= dim; ++k) {
    const bool first = k < (pair.kind == PrimitiveKind::edge_edge ? 2 : 1);
    if (solids[first ? pair.solid : pair.other].closed)
      out -= weights[k] * shapes.vertex_normal(pair.vertices[k]);
  }
  if (solids[pair.solid].closed || solids[pair.other].closed) {
    constexpr double opposite = 0.1, steep = 0.5;
    if (out.norm() < opposite)
      return Point<dim>::Zero();
    out.normalize();
    const double along = normal.dot(out);
    return std::abs(along) < steep ? out : Point<dim>(along > 0 ? normal : -normal);
  }
  const double leaves = normal.dot(motion);
  if (std::abs(leaves) <= negligible)
    return Point<dim>::Zero();
  return leaves > 0 ? Point<dim>(-normal) : normal;
}

template Point<2> touching_side<2>(const ContactShapes<2>&, const PrimitivePair<2>&,
                                   const PrimitiveWeights<2>&, const Point<2>&, const Point<2>&,
                                   double);
template Point<3> touching_side<3>(const ContactShapes<3>&, const PrimitivePair<3>&,
                                   const PrimitiveWeights<3>&, const Point<3>&, const Point<3>&,
                                   double);

}  // namespace lockstep
