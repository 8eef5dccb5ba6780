#pragma once
#include "conformance/violations.hpp"
#include "interfaces/solid.hpp"

namespace lockstep {

/// Holds a solid model against what SolidModel promises. Its solids should be in motion; they have
/// moved a little afterwards. Collective; every rank gets the same sentences.
template <int dim>
Violations check_solid(SolidModel<dim>& model);

}  // namespace lockstep
