#pragma once
#include "conformance/violations.hpp"
#include "interfaces/solid.hpp"

namespace lockstep {

/// Holds a solid model against what SolidModel promises. Its solids have other velocities
/// afterwards, and have moved a little. Collective; every rank gets the same sentences.
template <int dim>
Violations check_solid(SolidModel<dim>& model);

}  // namespace lockstep
