#pragma once
#include "parameters/parameter_list.hpp"
#include "rigid/rigid_body.hpp"

namespace lockstep {

/// Declares what the mass of a rigid body is, and where.
template <int dim>
void declare_mass(ParameterList& body);

/// Sets mass, inertia, centre of mass and volume of a body from its validated list (see
/// `rigid_body_parameters`); then the body's coordinates move to its reference point, whose old
/// coordinates [m] are returned. Throws InputError, also for inertias that no mass can have.
template <int dim>
Point<dim> set_mass(RigidBodyConstants<dim>& body, const ParameterList& list);

}  // namespace lockstep
