#include "rigid/body_motion.hpp"

#include "base/errors.hpp"
#include "motion/list_values.hpp"

namespace lockstep {

template <int dim>
void declare_motion(ParameterList& body) {
  const ParameterList nothing;
  std::vector<TypedSchema> schemas{
      {"dynamic", "Moved by its momentum, the fluid, gravity and contacts.", nothing},
      {"static", "Never moves.", nothing},
      {"constant velocity",
       "Keeps \"Velocity\" and \"Angular Velocity\"; \"Position\" is that of time 0.", nothing}};
  for (const TypedSchema& timed : timed_motion_schemas<dim>())
    schemas.push_back(timed);
  declare_typed_sublist(body, "Motion", "Motion of the body, by forces or by a script.", schemas,
                        "dynamic");
}

template <int dim>
MotionScript<dim> read_motion(const ParameterList& body, const std::string& name) {
  const ParameterList& list = body.sublist("Motion");
  const auto& type = list.get<std::string>("Type");
  if (type == "dynamic")
    return {};
  const Point<dim> velocity = vector_value<dim>(body, "Velocity");
  const AngularVector<dim> angular = rotation_value<dim>(body, "Angular Velocity");
  if (type == "constant velocity")
    return uniform_motion<dim>(velocity, angular);
  check_input(
      velocity.norm() == 0 && angular.norm() == 0,
      "The solid \"{}\" has a velocity, but its motion is \"{}\"; leave out \"Velocity\" and "
      "\"Angular Velocity\", or choose another motion.",
      name, type);
  if (type == "static")
    return uniform_motion<dim>(velocity, angular);
  return read_timed_motion<dim>(list, name + "/Motion");
}

template void declare_motion<2>(ParameterList&);
template void declare_motion<3>(ParameterList&);
template MotionScript<2> read_motion<2>(const ParameterList&, const std::string&);
template MotionScript<3> read_motion<3>(const ParameterList&, const std::string&);

}  // namespace lockstep
