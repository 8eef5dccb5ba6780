#pragma once
#include "base/communicator.hpp"
#include "staggered/domain/boundary.hpp"

namespace lockstep {

/// Reads the domain (`read_domain`) and checks that its cells fit into the memory of the machines,
/// before any of them are stored. Throws InputError. Collective.
template <int dim>
DomainDescription<dim> fitting_domain(const ParameterList& list, const Communicator& comm);

}  // namespace lockstep
