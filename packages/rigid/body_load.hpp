#pragma once
#include <string>

#include "parameters/parameter_list.hpp"
#include "rigid/rigid_body.hpp"

namespace lockstep {

/// Declares "Force" and "Torque" of a rigid body.
template <int dim>
void declare_load(ParameterList& body);

/// The load of a body from its validated list (see `rigid_body_parameters`); empty if nothing
/// pushes it. `name` is used in messages. Throws InputError, also if a load is given to a body that
/// is not dynamic.
template <int dim>
LoadLaw<dim> read_load(const ParameterList& body, const std::string& name, bool dynamic);

/// A load that stays the same; empty if it is zero.
template <int dim>
LoadLaw<dim> constant_load(const Load<dim>& load);

}  // namespace lockstep
