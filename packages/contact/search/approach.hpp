#pragma once
#include <algorithm>
#include <vector>

#include "contact/bodies/solid_motion.hpp"
#include "contact/search/primitive_pair.hpp"

namespace lockstep {

/// How far the vertices of a primitive, or of many, move within a step.
template <int dim>
struct PrimitiveMotion {
  Box<dim> moves;  ///< [m]
  /// Of a point beside it, which it carries along (`carried_point`), per distance from the
  /// primitive, besides the primitive's own move [1]; the largest.
  double turn = 0;
};

/// Of both together.
template <int dim>
PrimitiveMotion<dim> merged(const PrimitiveMotion<dim>& one, const PrimitiveMotion<dim>& other) {
  return {one.moves.merged(other.moves), std::max(one.turn, other.turn)};
}

/// False if primitives that are at least so far `apart` are farther than `thickness`, and no normal
/// velocity of a contact of theirs brings them to that within the step [m].
template <int dim>
bool may_close(const PrimitiveMotion<dim>& one, const PrimitiveMotion<dim>& other, double apart,
               double thickness);

/// How far parts of one solid that is not rigid come closer to each other within a step, at most:
/// what its motion leaves side by side need not be looked at closely. Local.
template <int dim>
class Approach {
 public:
  Approach(const ContactShapes<dim>& shapes, const SolidMotion<dim>& motion, int solid, double dt);

  /// Of the primitive with these vertices, [begin, end), held by that simplex.
  PrimitiveMotion<dim> of(const int* begin, const int* end, int simplex) const;
  /// `lockstep::may_close` of a pair of this solid.
  bool may_close(const PrimitivePair<dim>& pair, double apart, double thickness) const;

 private:
  int first_vertex_, first_simplex_;
  std::vector<Point<dim>> moves_;  ///< of vertices over the step [m]
  std::vector<double> turns_;      ///< of simplices
};

}  // namespace lockstep
