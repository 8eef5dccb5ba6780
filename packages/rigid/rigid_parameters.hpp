#pragma once
#include <string>

#include "parameters/parameter_list.hpp"
#include "rigid/rigid_body.hpp"

namespace lockstep {

/// Everything a solid of type "rigid body" may say, without "Type".
template <int dim>
ParameterList rigid_body_parameters();

/// A body at time 0 from its list, validated against `rigid_body_parameters`. A "File" of its
/// geometry must be absolute or relative to the working directory; `grid_spacing` [m] sets the
/// resolution of generated surfaces. Throws InputError. Every rank reads.
template <int dim>
RigidBody<dim> read_rigid_body(const std::string& name, const ParameterList& list,
                               double grid_spacing);

}  // namespace lockstep
