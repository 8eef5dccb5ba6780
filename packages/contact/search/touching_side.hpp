#pragma once
#include "contact/search/primitive_pairs.hpp"

namespace lockstep {

/// Direction from the second of two surfaces to the first where they coincide, so that their
/// points do not tell: along `normal` or against it, or where edges of closed solids meet that are
/// steep to it, between their normals; zero if nothing tells it. Closed solids are outside of each
/// other; a shell is on the side that it is about to leave. Not for a solid with itself, whose
/// seams may coincide for good.
///
/// `normal`: of the primitives, unit, of any sign. `motion`: of the first against the second in the
/// step if nothing held them [m]; up to `negligible` [m] it tells nothing.
template <int dim>
Point<dim> touching_side(const ContactShapes<dim>& shapes, const PrimitivePair<dim>& pair,
                         const PrimitiveWeights<dim>& weights, const Point<dim>& normal,
                         const Point<dim>& motion, double negligible);

}  // namespace lockstep
