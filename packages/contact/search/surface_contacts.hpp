#pragma once
#include <vector>

#include "contact/search/contact_search.hpp"
#include "contact/search/primitive_pairs.hpp"

namespace lockstep {

/// Contacts of two solids of which one is not rigid, or (solid == other) of one with itself: of
/// vertices with the insides of all near simplices, or else with the nearest rim, and of crossed
/// edges. The skins of both must not meet; surfaces have not crossed (see `find_impacts`), so the
/// side on which a point lies is where it belongs, and only the outer side of a closed solid
/// counts, but for vertices up to `reach.depth` inside another closed solid, which are pushed out.
/// A solid does not touch itself across one edge of its mesh: there only impacts count.
///
/// `primitives`: with boxes of vertices that hold their points alone.
template <int dim>
void add_surface_contacts(PrimitivePairs<dim>& primitives, const SolidMotion<dim>& motion,
                          const ContactReach& reach, int solid, int other,
                          std::vector<Contact<dim>>& contacts);

/// Point at which an impulse acts on both sides: on the surface that bends, for a rigid body
/// carries any point exactly.
template <int dim>
Point<dim> place_between(const ContactShapes<dim>& shapes, const Contact<dim>& contact) {
  if (shapes.solids()[contact.solid].rigid)
    return contact.other_point.position;
  if (shapes.solids()[contact.other].rigid)
    return contact.point.position;
  return 0.5 * (contact.point.position + contact.other_point.position);
}

}  // namespace lockstep
