#pragma once
#include <algorithm>
#include <vector>

#include "contact/bodies/solid_motion.hpp"
#include "contact/search/primitive_pair.hpp"

namespace lockstep {

/// Motion of the vertices of one or many primitives within a step.
template <int dim>
struct PrimitiveMotion {
  Box<dim> moves;  ///< [m]
  /// Largest motion of a point beside the primitive, which carries it along (`carried_point`), per
  /// distance from the primitive, besides the primitive's own move [1].
  double turn = 0;
};

/// Returns the motion of both primitives together.
template <int dim>
PrimitiveMotion<dim> merged(const PrimitiveMotion<dim>& one, const PrimitiveMotion<dim>& other) {
  return {one.moves.merged(other.moves), std::max(one.turn, other.turn)};
}

/// Returns false if primitives that are at least so far `apart` are farther than `thickness`, and
/// no normal velocity of a contact of theirs brings them to that within the step [m].
template <int dim>
bool may_close(const PrimitiveMotion<dim>& one, const PrimitiveMotion<dim>& other, double apart,
               double thickness);

/// Upper bound of how much closer parts of one solid that is not rigid come to each other within a
/// step: parts that its motion leaves side by side need no close search. Local.
template <int dim>
class Approach {
 public:
  Approach(const ContactShapes<dim>& shapes, const SolidMotion<dim>& motion, int solid, double dt);

  /// Motion of the primitive with these vertices, [begin, end), held by that simplex.
  PrimitiveMotion<dim> of(const int* begin, const int* end, int simplex) const;
  /// `lockstep::may_close` of a pair of this solid.
  bool may_close(const PrimitivePair<dim>& pair, double apart, double thickness) const;

 private:
  int first_vertex_, first_simplex_;
  std::vector<Point<dim>> moves_;  ///< moves of vertices over the step [m]
  std::vector<double> turns_;      ///< turns of simplices
};

}  // namespace lockstep
