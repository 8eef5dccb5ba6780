#pragma once
#include <vector>

#include "contact/bodies/solid_motion.hpp"
#include "contact/search/primitive_pairs.hpp"

namespace lockstep {

/// How far parts of one solid that is not rigid come closer to each other within a step, at most:
/// what its motion leaves side by side need not be looked at closely. Local.
template <int dim>
class Approach {
 public:
  Approach(const ContactShapes<dim>& shapes, const SolidMotion<dim>& motion, int solid, double dt);

  /// False if primitives that are at least so far `apart` are farther than `thickness`, and no
  /// normal velocity of a contact of theirs brings them to that within the step [m].
  bool may_close(const PrimitivePair<dim>& pair, double apart, double thickness) const;
  /// The distance of their boxes [m].
  double distance_of_boxes(const PrimitivePair<dim>& pair) const;

 private:
  const std::vector<Point<dim>>& positions_;
  int first_vertex_, first_simplex_;
  std::vector<Point<dim>> moves_;  ///< of vertices over the step [m]
  /// By simplex: of a point beside it, which it carries along (`carried_point`), per distance from
  /// the simplex, besides the simplex' own move [1].
  std::vector<double> turns_;
};

}  // namespace lockstep
