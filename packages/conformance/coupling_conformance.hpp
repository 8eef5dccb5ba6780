#pragma once
#include "conformance/violations.hpp"
#include "coupling/solid_system.hpp"
#include "interfaces/coupling.hpp"

namespace lockstep {

/// Holds a coupling against what Coupling promises, between this fluid and these solids, of which
/// at least one must be free to move, and whose effective velocities must be those of a `move` that
/// takes no time, as FakeSolid's are. Collective; every rank gets the same sentences.
template <int dim>
Violations check_coupling(Coupling<dim>& coupling, FluidDiscretization<dim>& fluid,
                          SolidSystem<dim>& solids);

}  // namespace lockstep
