#include "motion/motion_script.hpp"

#include <cmath>
#include <vector>

#include "base/errors.hpp"
#include "motion/list_values.hpp"
#include "motion/timed_table.hpp"

namespace lockstep {

namespace {

template <int dim>
ParameterList sinusoid_schema() {
  ParameterList sinusoid;
  declare_vector(sinusoid, "Amplitude", ParameterArray<double>(dim, 0.0), dim,
                 "Largest displacement [m].");
  declare_rotation<dim>(sinusoid, "Angular Amplitude",
                        dim == 2 ? "Largest angle [rad]." : "Largest rotation vector [rad].");
  declare_required_positive(sinusoid, "Frequency", "Oscillations per second [1/s].");
  declare(sinusoid, "Phase", 0.0,
          "The motion is amplitude times sin(2 pi frequency time + phase) [rad].");
  return sinusoid;
}

template <int dim>
ParameterList table_schema() {
  ParameterList table;
  declare_times(table);
  declare_optional<ParameterArray<double>>(
      table, "Displacements",
      "Displacement [m]: a point for each time, one after another. Absent: none.");
  declare_optional<ParameterArray<double>>(table, "Angles",
                                           "Angle of the turn for each time [rad]. Absent: none.");
  if (dim == 3)
    declare_vector(table, "Axis", {0.0, 0.0, 1.0}, 3, "Axis of the angles [1].");
  return table;
}

template <int dim>
MotionScript<dim> sinusoid(const ParameterList& list, const std::string& where) {
  const Point<dim> amplitude = vector_value<dim>(list, "Amplitude");
  const AngularVector<dim> turn = rotation_value<dim>(list, "Angular Amplitude");
  check_input(!amplitude.isZero() || !turn.isZero(),
              "In \"{}\", the sinusoid moves nothing: give it an \"Amplitude\" or an \"Angular "
              "Amplitude\", or make the motion \"static\".",
              where);
  const double rate = 2 * pi * list.get<double>("Frequency");
  const double phase = list.get<double>("Phase");
  return [=](double time) {
    const double sine = std::sin(rate * time + phase);
    const double derivative = rate * std::cos(rate * time + phase);
    return ScriptedMotion<dim>{sine * amplitude, sine * turn, derivative * amplitude,
                               derivative * turn};
  };
}

template <int dim>
AngularVector<dim> table_axis(const ParameterList& list, const std::string& where) {
  if constexpr (dim == 2) {
    return AngularVector<2>(1.0);
  } else {
    const Point<3> axis = vector_value<3>(list, "Axis");
    check_input(axis.norm() > 0, "In \"{}\", \"Axis\" must not be zero.", where);
    return axis.normalized();
  }
}

template <int dim>
MotionScript<dim> table(const ParameterList& list, const std::string& where) {
  const std::vector<double> times = read_times(list, where);
  const auto displacements = read_columns(list, "Displacements", times, dim, where);
  const auto angles = read_columns(list, "Angles", times, 1, where);
  check_input(!displacements.empty() || !angles.empty(),
              "In \"{}\", the table moves nothing: give it \"Displacements\" or \"Angles\", or "
              "make the motion \"static\".",
              where);
  const AngularVector<dim> axis = table_axis<dim>(list, where);
  return [=](double time) {
    ScriptedMotion<dim> motion;
    for (std::size_t a = 0; a < displacements.size(); ++a) {
      motion.displacement[a] = displacements[a].value(time);
      motion.velocity[a] = displacements[a].slope(time);
    }
    if (!angles.empty()) {
      motion.turn = angles[0].value(time) * axis;
      motion.angular_velocity = angles[0].slope(time) * axis;
    }
    return motion;
  };
}

}  // namespace

template <int dim>
std::vector<TypedSchema> timed_motion_schemas() {
  return {{"sinusoid", "Swings about the position and orientation of the start.",
           sinusoid_schema<dim>()},
          {"table",
           "Follows a table through a monotone cubic interpolation, whose velocity is continuous "
           "from its first time to its last. At rest before and after: there it jumps, unless the "
           "first two rows are alike, and the last two.",
           table_schema<dim>()}};
}

template <int dim>
MotionScript<dim> read_timed_motion(const ParameterList& list, const std::string& where) {
  return list.get<std::string>("Type") == "table" ? table<dim>(list, where)
                                                  : sinusoid<dim>(list, where);
}

template <int dim>
MotionScript<dim> uniform_motion(const Point<dim>& velocity, const AngularVector<dim>& angular) {
  return [velocity, angular](double time) {
    return ScriptedMotion<dim>{time * velocity, time * angular, velocity, angular};
  };
}

template std::vector<TypedSchema> timed_motion_schemas<2>();
template std::vector<TypedSchema> timed_motion_schemas<3>();
template MotionScript<2> read_timed_motion<2>(const ParameterList&, const std::string&);
template MotionScript<3> read_timed_motion<3>(const ParameterList&, const std::string&);
template MotionScript<2> uniform_motion<2>(const Point<2>&, const AngularVector<2>&);
template MotionScript<3> uniform_motion<3>(const Point<3>&, const AngularVector<3>&);

}  // namespace lockstep
