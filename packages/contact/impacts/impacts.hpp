#pragma once
#include <vector>

#include "contact/search/contact_search.hpp"
#include "contact/search/primitive_pairs.hpp"

namespace lockstep {

/// Two primitives that would pass through each other.
template <int dim>
struct FoundImpact {
  PrimitivePair<dim> pair;
  Impact<dim> impact;
};

/// The motion of all surface vertices over a step: straight, rigid solids ending where they do.
template <int dim>
struct SurfacePath {
  SurfacePath(const ContactShapes<dim>& shapes, const SolidMotion<dim>& motion, double dt);
  std::vector<Point<dim>> before, after;
  /// Places of the vertices if nothing held them, which tell the sides of primitives that coincide
  /// before; empty: `after`.
  std::vector<Point<dim>> unheld;
};

/// First impacts of all pairs of primitives of which at least one is of a solid that is not rigid;
/// also of a solid with itself; not where one is glued to the other (`hangs_on`). Local;
/// the same on all ranks.
template <int dim>
std::vector<FoundImpact<dim>> find_impacts(const ContactShapes<dim>& shapes,
                                           const SurfacePath<dim>& path);

/// Makes the contact that keeps the primitives of an impact `clearance` apart at the end (but at
/// most half of their distance at the start): its gap over dt is the largest normal speed of
/// approach.
template <int dim>
Contact<dim> impact_contact(const ContactShapes<dim>& shapes, const SolidMotion<dim>& motion,
                            const SurfacePath<dim>& path, const FoundImpact<dim>& found,
                            double clearance, double dt);

}  // namespace lockstep
