#pragma once
#include <string>

#include "motion/motion_script.hpp"

namespace lockstep {

/// Declares the typed sublist "Motion" of a rigid body.
template <int dim>
void declare_motion(ParameterList& body);

/// The script of a body from its validated list (see `rigid_body_parameters`); empty if the body is
/// dynamic. `name` is used in messages. Throws InputError.
template <int dim>
MotionScript<dim> read_motion(const ParameterList& body, const std::string& name);

}  // namespace lockstep
