#pragma once
#include <functional>
#include <string>
#include <vector>

#include "base/types.hpp"
#include "parameters/parameter_list.hpp"

namespace lockstep {

/// Where something prescribed is at some time, relative to its start, and how it moves there.
template <int dim>
struct ScriptedMotion {
  Point<dim> displacement = Point<dim>::Zero();  ///< displacement of the reference point [m]
  AngularVector<dim> turn = AngularVector<dim>::Zero();  ///< rotation vector [rad]
  Point<dim> velocity = Point<dim>::Zero();              ///< velocity of the reference point [m/s]
  AngularVector<dim> angular_velocity = AngularVector<dim>::Zero();  ///< [rad/s]
};

/// A motion as a function of time [s]. The turn keeps its axis, so that its derivative is the
/// angular velocity. Empty for what is not prescribed.
template <int dim>
using MotionScript = std::function<ScriptedMotion<dim>(double time)>;

/// Schemas of the motions that a list describes alone: "sinusoid" and "table", for a typed sublist.
template <int dim>
std::vector<TypedSchema> timed_motion_schemas();

/// The script of a validated list of one of these types; `where` names the list in messages. Throws
/// InputError.
template <int dim>
MotionScript<dim> read_timed_motion(const ParameterList& list, const std::string& where);

/// Constant velocity [m/s] and angular velocity [rad/s]; displacement and turn are zero at time 0.
template <int dim>
MotionScript<dim> uniform_motion(const Point<dim>& velocity, const AngularVector<dim>& angular);

}  // namespace lockstep
