#include "rigid/rigid_parameters.hpp"

#include <algorithm>

#include "base/errors.hpp"
#include "motion/list_values.hpp"
#include "rigid/body_geometry.hpp"
#include "rigid/body_load.hpp"
#include "rigid/body_mass.hpp"
#include "rigid/body_motion.hpp"

namespace lockstep {

namespace {

template <int dim>
std::vector<std::string> dof_names() {
  if (dim == 2)
    return {"x", "y", "rotation"};
  return {"x", "y", "z", "rotation x", "rotation y", "rotation z"};
}

template <int dim>
void declare_pose(ParameterList& list) {
  declare_vector(list, "Position", ParameterArray<double>(dim, 0.0), dim,
                 "Where the origin of the body's coordinates lies at the start [m].");
  declare_rotation<dim>(list, "Rotation",
                        dim == 2 ? "Angle by which the body is turned about that origin at the "
                                   "start [rad]."
                                 : "Rotation vector (axis times angle) by which the body is turned "
                                   "about that origin at the start [rad].");
  declare_vector(list, "Velocity", ParameterArray<double>(dim, 0.0), dim,
                 "Velocity of the reference point (centre of mass, or pivot) at the start [m/s].");
  declare_rotation<dim>(list, "Angular Velocity", "Angular velocity at the start [rad/s].");
  declare_optional<ParameterArray<double>>(
      list, "Pivot",
      "Reference point, in coordinates of the body [m]: what locked translations hold (a hinge) "
      "and scripts turn about. Default: the centre of mass.");
  set_length(list, "Pivot", dim);
}

template <int dim>
void set_locks(RigidBodyConstants<dim>& body, const ParameterList& list,
               const RigidVector<dim>& velocity) {
  const auto names = dof_names<dim>();
  for (const auto& name : list.get<ParameterArray<std::string>>("Locked")) {
    const auto k = std::find(names.begin(), names.end(), name) - names.begin();
    check_input(!body.script,
                "The solid \"{}\" follows a script, so nothing of it can be locked; leave out "
                "\"Locked\", or make its motion \"dynamic\".",
                body.name);
    check_input(
        velocity[k] == 0,
        "The solid \"{}\" has \"{}\" locked, but starts with a velocity of {} there; set it "
        "to zero.",
        body.name, name, velocity[k]);
    check_input(!body.locked[k], "The solid \"{}\" has \"{}\" twice in \"Locked\"; once is enough.",
                body.name, name);
    body.locked[k] = true;
  }
}

}  // namespace

template <int dim>
ParameterList rigid_body_parameters() {
  ParameterList list("rigid body");
  declare_geometry<dim>(list);
  declare_mass<dim>(list);
  declare_pose<dim>(list);
  declare(list, "Locked", ParameterArray<std::string>(),
          "Motions held at zero, along and about the axes of space.");
  set_choices(list, "Locked", dof_names<dim>());
  declare_motion<dim>(list);
  declare_load<dim>(list);
  declare(list, "Seen by Fluid", true,
          "Fluid and contact meet the body's surface. Without, the body is a mass that joints and "
          "attached nodes connect, as a bone inside flesh.");
  declare_between(list, "Restitution", 0.0, 0.0, 1.0,
                  "Speed after over speed before a collision [1].");
  declare_at_least(list, "Friction", 0.0, 0.0, "Coulomb's coefficient of contacts [1].");
  return list;
}

template <int dim>
RigidBody<dim> read_rigid_body(const std::string& name, const ParameterList& list,
                               double grid_spacing) {
  RigidBody<dim> body;
  body.name = name;
  body.script = read_motion<dim>(list, name);
  BodyGeometry<dim> geometry =
      make_body_geometry<dim>(list.sublist("Geometry"), grid_spacing, name);
  body.surface = std::move(geometry.surface);
  body.closed = geometry.closed;
  body.load = read_load<dim>(list, name, body.dynamic());
  body.seen_by_fluid = list.get<bool>("Seen by Fluid");
  body.restitution = list.get<double>("Restitution");
  body.friction = list.get<double>("Friction");
  const Point<dim> reference = set_mass(body, list);
  RigidVector<dim> velocity;
  velocity << vector_value<dim>(list, "Velocity"), rotation_value<dim>(list, "Angular Velocity");
  set_locks(body, list, velocity);
  body.pose.orientation = rotation_of<dim>(rotation_value<dim>(list, "Rotation"));
  body.pose.position = vector_value<dim>(list, "Position") + body.pose.orientation * reference;
  body.initial_pose = body.pose;
  if (body.dynamic())
    set_velocity(body, velocity);
  else
    follow_script(body, 0);
  return body;
}

template ParameterList rigid_body_parameters<2>();
template ParameterList rigid_body_parameters<3>();
template RigidBody<2> read_rigid_body<2>(const std::string&, const ParameterList&, double);
template RigidBody<3> read_rigid_body<3>(const std::string&, const ParameterList&, double);

}  // namespace lockstep
