#pragma once
#include "interfaces/registries.hpp"

namespace lockstep {

/// Parameters of the contact model "gauss seidel".
ParameterList contact_parameters();

/// Registers the contact model "gauss seidel".
template <int dim>
void register_contact(ContactRegistry<dim>& contacts);

}  // namespace lockstep
