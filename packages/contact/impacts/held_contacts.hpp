#pragma once
#include <vector>

#include "contact/impacts/impacts.hpp"

namespace lockstep {

/// Makes contacts of impacts that impact zones held back, where the surfaces are now, as if they
/// touched, so that momentum follows. Without them bodies that zones keep from meeting would stay
/// where they are, ever faster, as nothing near them takes their momentum. Where a vertex is
/// between two rigid solids they touch each other through it, too: through nodes that are much
/// lighter than they are, Gauss-Seidel would take a sweep for every part of their mass. Impulses
/// act at one point on both sides, so momentum is exact. Local; the same on all ranks.
template <int dim>
std::vector<Contact<dim>> held_contacts(const ContactShapes<dim>& shapes,
                                        const std::vector<FoundImpact<dim>>& held_back);

}  // namespace lockstep
