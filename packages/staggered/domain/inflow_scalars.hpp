#pragma once
#include "staggered/domain/boundary.hpp"

namespace lockstep {

/// Declares what an inflow carries in the list of a side.
template <int dim>
void declare_inflow_scalars(ParameterList& side);

/// Reads the scalars that inflows carry: as their sides say in a validated list "Domain", else the
/// ambient ones of the list "Fluid". Throws InputError if a side that says so is no inflow, or the
/// fluid carries none.
template <int dim>
void read_inflow_scalars(const ParameterList& fluid, const ParameterList& domain,
                         Boundary<dim>& boundary);

}  // namespace lockstep
