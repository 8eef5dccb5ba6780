#include "articulated/joint_parameters.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "articulated/joint_promises.hpp"
#include "base/errors.hpp"
#include "base/round_off.hpp"
#include "motion/list_values.hpp"
#include "parameters/suggestion.hpp"

namespace lockstep {

namespace {

const std::string name_of_space = "space";

/// Volume of the ball with as much surface as a solid, 0 if it has none [m^dim]: about the volume
/// of fluid that the solid pushes, shells too, and independent of its orientation.
template <int dim>
double volume_pushed(const SurfaceMesh<dim>& surface, const SolidDescription& solid) {
  double area = 0;
  for (int s = solid.simplex_begin; s < solid.simplex_end; ++s) {
    std::array<Point<dim>, dim> corners;
    for (int k = 0; k < dim; ++k)
      corners[k] = surface.vertices[surface.simplices[s][k]];
    area += area_vector<dim>(corners).norm();
  }
  return dim == 2 ? area * area / (4 * pi) : std::sqrt(area * area * area / (36 * pi));
}

/// Solids that joints name, found among all.
template <int dim>
class BodyFinder {
 public:
  explicit BodyFinder(const JointSetting<dim>& setting) : setting_(setting) {
    for (const auto& model : setting.models) {
      for (const SolidDescription& solid : model->solids())
        names_.push_back(solid.name);
    }
  }

  int find(const std::string& joint, const std::string& name) {
    if (name == name_of_space)
      return space;
    const auto known = place_.find(name);
    if (known != place_.end())
      return known->second;
    bodies_.push_back(body_of(joint, name));
    return place_[name] = static_cast<int>(bodies_.size()) - 1;
  }
  const std::vector<JointedBody<dim>>& bodies() const { return bodies_; }

  /// Finds out which of the bodies found so far carry nodes. Collective.
  void find_carriers() {
    std::vector<char> carries(bodies_.size(), 0);
    for (const auto& model : setting_.models) {
      for (const NodeAttachment<dim>& node : model->attachments()) {
        const auto place = place_.find(node.solid);
        if (place != place_.end())
          carries[place->second] = 1;
      }
    }
    max_over_ranks(setting_.comm, carries);
    for (std::size_t b = 0; b < bodies_.size(); ++b)
      bodies_[b].carries_nodes = carries[b] > 0;
  }

 private:
  JointedBody<dim> body_of(const std::string& joint, const std::string& name) const {
    GlobalIndex first = 0;
    for (const auto& model : setting_.models) {
      const auto& solids = model->solids();
      for (std::size_t s = 0; s < solids.size(); ++s) {
        if (solids[s].name != name)
          continue;
        const auto* jointable = model->jointable();
        check_input(jointable,
                    "The joint \"{}\" names the solid \"{}\", which is not rigid; joints "
                    "connect rigid bodies, attach its nodes to one.",
                    joint, name);
        const int number = static_cast<int>(s);
        const std::string other = jointable->unjointable(number);
        check_input(other.empty(), "\"{}\" is jointed, so it has no \"{}\"; use a joint to \"{}\".",
                    name, other, name_of_space);
        const GlobalIndex own = jointable->first_dof(number);
        return {name,
                jointable,
                number,
                own == no_index ? no_index : first + own,
                jointable->rigid_frame(number).mass(0, 0),
                setting_.fluid_density * volume_pushed(model->surface(), solids[s])};
      }
      first += static_cast<GlobalIndex>(model->dof_map()->getGlobalNumElements());
    }
    const std::string nearest = nearest_name(name, names_);
    throw InputError(fmt::format("The joint \"{}\" names the solid \"{}\", but there is none; {}",
                                 joint, name,
                                 nearest.empty() ? "name one of \"Solids\", or \"space\"."
                                                 : "did you mean \"" + nearest + "\"?"));
  }

  const JointSetting<dim>& setting_;
  std::vector<std::string> names_;
  std::vector<JointedBody<dim>> bodies_;
  std::map<std::string, int> place_;
};

template <int dim>
Point<dim> direction(const ParameterList& list, const std::string& parameter,
                     const std::string& name) {
  const Point<dim> axis = vector_value<dim>(list, parameter);
  check_input(axis.norm() > 0, "The \"{}\" of the joint \"{}\" must not be zero.", parameter, name);
  return axis.normalized();
}

/// The joint's axes in space: those that are named first, `n_named`.
Axes<2> axes_of(const Point<2>& axis, const ParameterList&, const std::string&, int) {
  Axes<2> axes;
  axes << axis, Point<2>(-axis.y(), axis.x());
  return axes;
}
Axes<3> axes_of(const Point<3>& axis, const ParameterList& list, const std::string& name,
                int n_named) {
  Axes<3> axes;
  axes.col(0) = axis;
  axes.col(1) = axis.unitOrthogonal();
  if (n_named == 2) {
    axes.col(1) = direction<3>(list, "Second Axis", name);
    check_input(std::abs(axis.dot(axes.col(1))) <= rounding::differences,
                "The \"Second Axis\" of the joint \"{}\" must be at right angles to its \"Axis\".",
                name);
  }
  axes.col(2) = Point<3>(axes.col(0)).cross(Point<3>(axes.col(1)));
  return axes;
}

/// No limit stops a coordinate that is given.
template <int dim>
void check_limits(const Joint<dim>& joint) {
  for (int k = 0; k < static_cast<int>(joint.control.coordinates.size()); ++k) {
    const CoordinateControl& control = joint.control.coordinates[k];
    check_input(
        !control.given() || !joint.limits.bounds(k),
        "The joint \"{}\" is under \"{}\" control, which no limit stops; leave out its "
        "limits{}.",
        joint.name, control.type == ControlType::prescribed ? "prescribed" : "prescribed rate",
        joint.control.coordinates.size() > 1 ? fmt::format(" of coordinate {}", k + 1) : "");
  }
}

template <int dim>
Joint<dim> read_joint(const std::string& name, const ParameterList& list, BodyFinder<dim>& finder,
                      const JointTypes<dim>& types) {
  Joint<dim> joint;
  joint.name = name;
  joint.type = list.get<std::string>("Type");
  joint.kind = types.joints->create(joint.type, list);
  const std::string broken =
      broken_promise(*joint.kind, Eigen::VectorXd::Zero(joint.kind->n_rates()));
  check_input(broken.empty(), "The joint type \"{}\" {}: its plug-in must be mended.", joint.type,
              broken);
  const JointFreedom& freedom = joint.kind->freedom();
  const auto& solids = list.get<ParameterArray<std::string>>("Solids");
  check_input(solids[0] != solids[1], "The joint \"{}\" connects \"{}\" with itself; name two.",
              name, solids[0]);
  const Point<dim> point = vector_value<dim>(list, "Point");
  Axes<dim> axes = Axes<dim>::Identity();
  if (freedom.axes > 0)
    axes = axes_of(direction<dim>(list, "Axis", name), list, name, freedom.axes);
  bool movable = false;
  for (int side = 0; side < 2; ++side) {
    const int body = finder.find(name, solids[side]);
    BodyPose<dim> pose;
    if (body != space) {
      const JointedBody<dim>& one = finder.bodies()[body];
      const RigidFrame<dim> frame = one.model->rigid_frame(one.solid);
      pose = {frame.position, frame.orientation.toRotationMatrix()};
      movable = movable || !one.prescribed();
    }
    joint.sides[side] = {body, pose.rotation.transpose() * (point - pose.position),
                         pose.rotation.transpose() * axes};
  }
  if (joint.kind->n_rates() > 0)
    joint.control =
        read_control(list, freedom, {joint.kind->n_rates(), name, point}, *types.targets);
  joint.limits = read_limits(list, name, freedom);
  check_limits(joint);
  check_input(movable, "The joint \"{}\" connects two prescribed solids; nothing can move it.",
              name);
  return joint;
}

}  // namespace

template <int dim>
ParameterList joint_parameters(const JointFreedom& freedom, const TargetRegistry& targets) {
  const int n = freedom.n_coordinates();
  ParameterList list;
  declare_required_vector<std::string>(
      list, "Solids", 2,
      "The two solids that the joint connects: rigid bodies, dynamic or prescribed, or \"space\". "
      "The joint's axes go with the first.");
  declare_required_vector<double>(list, "Point", dim,
                                  "Place of the joint at the start, in space [m].");
  if (freedom.axes > 0)
    declare_required_vector<double>(list, "Axis", dim,
                                    "Axis of the joint at the start, in space, of any length [1].");
  if (freedom.axes > 1)
    declare_required_vector<double>(
        list, "Second Axis", dim,
        "Second axis at the start, at right angles to \"Axis\", of any length [1].");
  if (n > 0) {
    declare_control(list, n, targets);
    declare_limits(list, freedom);
  }
  for (int k = 0; k < n && freedom.has_separate_coordinates(); ++k) {
    ParameterList& own = declare_optional_list(
        list, coordinate_list(k),
        fmt::format(
            "Settings of this {} alone. With a \"Control\" here nothing of the joint's own control "
            "acts on "
            "it; a limit here takes the place of the joint's for it. The joint's own settings "
            "hold where this list is silent.",
            k < freedom.displacements ? "displacement" : "angle"));
    declare_control(own, 1, targets);
    declare_limit_pair(own, 1);
  }
  return list;
}

ParameterList articulation_parameters() {
  ParameterList list("joints");
  declare_choice(
      list, "Impulses", "two halves", {"two halves", "end of step"},
      "Times at which the impulses of joints act. two halves: half of them where a step begins, "
      "half where it ends; second order, and hardly any energy is lost, for one more coupled solve "
      "a step. end of step: all of them there; loses energy at large steps.");
  declare_choice(list, "Time Integration", "second-order", {"second-order", "fully-implicit"},
                 "Integration of springs and dampers. second-order: the spring is that of the "
                 "middle of the step, half of the damper explicit; fully-implicit: both at its "
                 "end, of first order, and damps whatever the step does not resolve.");
  return list;
}

template <int dim>
std::shared_ptr<Articulation<dim>> read_joints(const ParameterList& shared,
                                               const NamedLists& joints,
                                               const JointSetting<dim>& setting,
                                               const JointTypes<dim>& types) {
  ArticulationOptions options;
  options.two_halves = shared.get<std::string>("Impulses") == "two halves";
  options.fully_implicit = shared.get<std::string>("Time Integration") == "fully-implicit";
  options.largest_turn = setting.largest_turn;
  BodyFinder<dim> finder(setting);
  std::vector<Joint<dim>> all;
  for (const auto& [name, list] : joints)
    all.push_back(read_joint<dim>(name, list, finder, types));
  finder.find_carriers();
  GlobalIndex n_dofs = 0;
  for (const auto& model : setting.models)
    n_dofs += static_cast<GlobalIndex>(model->dof_map()->getGlobalNumElements());
  return std::make_shared<Articulation<dim>>(finder.bodies(), std::move(all), options, n_dofs);
}

template ParameterList joint_parameters<2>(const JointFreedom&, const TargetRegistry&);
template ParameterList joint_parameters<3>(const JointFreedom&, const TargetRegistry&);
template std::shared_ptr<Articulation<2>> read_joints(const ParameterList&, const NamedLists&,
                                                      const JointSetting<2>&, const JointTypes<2>&);
template std::shared_ptr<Articulation<3>> read_joints(const ParameterList&, const NamedLists&,
                                                      const JointSetting<3>&, const JointTypes<3>&);

}  // namespace lockstep
