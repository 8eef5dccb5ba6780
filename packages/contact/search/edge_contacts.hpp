#pragma once
#include <vector>

#include "contact/search/contact_search.hpp"

namespace lockstep {

/// Convex sharp edges (and facets of shells) of two solids that cross within `reach.near`, or
/// overlap by up to `reach.depth`: contacts that no vertex finds. The motion is not followed.
void add_edge_contacts(const ContactShapes<3>& shapes, const ContactReach& reach, int solid,
                       int other, std::vector<Contact<3>>& contacts);

}  // namespace lockstep
