#pragma once
#include <functional>
#include <string>

#include "base/types.hpp"
#include "parameters/parameter_list.hpp"

namespace lockstep {

/// Where a prescribed body is at some time, relative to its initial pose, and how it moves there.
template <int dim>
struct ScriptedMotion {
  Point<dim> displacement = Point<dim>::Zero();          ///< of the reference point [m]
  AngularVector<dim> turn = AngularVector<dim>::Zero();  ///< rotation vector [rad]
  Point<dim> velocity = Point<dim>::Zero();              ///< of the reference point [m/s]
  AngularVector<dim> angular_velocity = AngularVector<dim>::Zero();  ///< [rad/s]
};

/// A motion as a function of time [s]. The turn keeps its axis, so that its derivative is the
/// angular velocity. Empty for a dynamic body.
template <int dim>
using MotionScript = std::function<ScriptedMotion<dim>(double time)>;

/// Declares the typed sublist "Motion".
template <int dim>
void declare_motion(ParameterList& body);

/// The script of a body from its validated list (see `rigid_body_parameters`); empty if the body is
/// dynamic. `name` is used in messages. Throws InputError.
template <int dim>
MotionScript<dim> read_motion(const ParameterList& body, const std::string& name);

}  // namespace lockstep
