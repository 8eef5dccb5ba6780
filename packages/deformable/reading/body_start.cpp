#include "deformable/reading/body_start.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "base/errors.hpp"
#include "deformable/elements/shell_elements.hpp"
#include "deformable/reading/node_region.hpp"
#include "deformable/reading/pinned_regions.hpp"
#include "motion/list_values.hpp"

namespace lockstep {

namespace {

template <int dim>
void declare_start(ParameterList& body) {
  declare_vector(body, "Position", ParameterArray<double>(dim, 0.0), dim,
                 "Position of the origin of the body's coordinates at the start [m].");
  if constexpr (dim == 2) {
    declare(body, "Rotation", 0.0,
            "Angle by which the body is turned about that origin at the start [rad].");
    declare(body, "Angular Velocity", 0.0,
            "Angular velocity about that origin at the start [rad/s].");
  } else {
    declare_vector(body, "Rotation", {0.0, 0.0, 0.0}, 3,
                   "Rotation vector (axis times angle) by which the body is turned about that "
                   "origin at the start [rad].");
    declare_vector(body, "Angular Velocity", {0.0, 0.0, 0.0}, 3,
                   "Angular velocity about that origin at the start [rad/s].");
  }
  declare_vector(body, "Velocity", ParameterArray<double>(dim, 0.0), dim,
                 "Velocity of that origin at the start [m/s].");
  declare_vector(body, "Stretch", ParameterArray<double>(dim, 1.0), dim,
                 "Factors along the body's axes by which it is stretched at the start, before it "
                 "is turned [1].");
  set_positive(body, "Stretch");
  ParameterList& vortices = declare_optional_list(
      body, "Vortices",
      "Velocity at the start on top: that of the fluid's initial state \"taylor green\".");
  declare(vortices, "Amplitude", 1.0, "Largest velocity U [m/s].");
  declare_positive(vortices, "Wavelength", 1.0, "Length of one period, 2 pi / k [m].");
}

template <int dim>
void add_vortices(const ParameterList& list, DeformableBody<dim>& body) {
  const double amplitude = list.get<double>("Amplitude");
  const double k = 2 * M_PI / list.get<double>("Wavelength");
  for (int n = 0; n < body.n_nodes(); ++n) {
    const Point<dim>& x = body.position[n];
    body.velocity[n][0] += amplitude * std::sin(k * x[0]) * std::cos(k * x[1]);
    body.velocity[n][1] -= amplitude * std::cos(k * x[0]) * std::sin(k * x[1]);
  }
}

template <int dim>
AngularVector<dim> read_angular_velocity(const ParameterList& list) {
  if constexpr (dim == 2) {
    return AngularVector<2>(list.get<double>("Angular Velocity"));
  } else {
    return vector_value<3>(list, "Angular Velocity");
  }
}

/// Positions and velocities of the nodes at the start.
template <int dim>
void place(const ParameterList& list, const std::vector<Point<dim>>& rest,
           DeformableBody<dim>& body) {
  const Point<dim> origin = vector_value<dim>(list, "Position");
  const Point<dim> velocity = vector_value<dim>(list, "Velocity");
  const Point<dim> stretch = vector_value<dim>(list, "Stretch");
  const AngularVector<dim> angular_velocity = read_angular_velocity<dim>(list);
  const Eigen::Matrix<double, dim, dim> rotation = start_rotation<dim>(list);
  for (const Point<dim>& x : rest) {
    const Point<dim> arm = rotation * x.cwiseProduct(stretch);
    body.position.push_back(origin + arm);
    body.velocity.push_back(velocity + rotate<dim>(angular_velocity, arm));
  }
  if (list.isSublist("Vortices"))
    add_vortices<dim>(list.sublist("Vortices"), body);
}

TimeIntegration read_integration(const ParameterList& list) {
  const auto& name = list.get<std::string>("Time Integration");
  if (name == "explicit")
    return TimeIntegration::explicit_forces;
  if (name == "semi-implicit")
    return TimeIntegration::semi_implicit;
  return name == "second-order" ? TimeIntegration::second_order : TimeIntegration::fully_implicit;
}

bool is_implicit(TimeIntegration integration) {
  return integration == TimeIntegration::fully_implicit ||
         integration == TimeIntegration::second_order;
}

/// Anchors are locked nodes of their own, without mass and off the surface.
template <int dim>
void add_tethers(const std::vector<Tether<dim>>& tethers, DeformableBody<dim>& body) {
  std::vector<Spring> all;
  for (const Tether<dim>& tether : tethers) {
    all.push_back({{tether.node, body.n_nodes()}, tether.stiffness, 0});
    body.position.push_back(body.position[tether.node] + tether.offset);
    body.velocity.push_back(Point<dim>::Zero());
    body.force.push_back(Point<dim>::Zero());
    std::array<bool, dim> locked;
    locked.fill(true);
    body.locked.push_back(locked);
  }
  if (!all.empty())
    body.elements.push_back(springs<dim>(all, 0));
}

}  // namespace

template <int dim>
Eigen::Matrix<double, dim, dim> start_rotation(const ParameterList& list) {
  if constexpr (dim == 2) {
    return Eigen::Rotation2Dd(list.get<double>("Rotation")).toRotationMatrix();
  } else {
    const Point<3> turn = vector_value<3>(list, "Rotation");
    const double angle = turn.norm();
    return angle == 0 ? Eigen::Matrix3d(Eigen::Matrix3d::Identity())
                      : Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix();
  }
}

template <int dim>
void declare_body_start(ParameterList& list, const std::string& integration) {
  declare_choice(list, "Mass", "lumped", {"lumped", "consistent"},
                 "lumped: a share of each element on its corners. consistent: the mass matrix of "
                 "the finite elements.");
  declare_at_least(list, "Stiffness Damping", 0.0, 0.0,
                   "Rayleigh's factor of the stiffness at rest [s]: a mode of angular frequency w "
                   "has w/2 times this of critical damping.");
  declare_choice(
      list, "Time Integration", integration,
      {"explicit", "semi-implicit", "fully-implicit", "second-order"},
      "explicit: all forces at the present state. semi-implicit: elastic forces at the "
      "present positions, implicit damping. fully-implicit: both linearised and solved "
      "together with the fluid; stable at any step, but of first order: the energy of a mode of "
      "angular frequency w falls by 3/2 (w dt)^2 of itself a step. second-order: the same with the "
      "elastic forces of the middle of the step, where it falls by (w dt)^4/8 while w dt is small; "
      "for free vibrations and waves; volumes that nothing holds go along arcs as they turn. The "
      "step of explicit and semi-implicit bodies is bounded by the stiffest element.");
  declare_at_least(
      list, "Most Sub-Steps", 1, 1,
      "Explicit and semi-implicit only: elastic forces are averaged over up to so many sub-steps "
      "of the body alone where a step is longer than its stable one. Modes slower than the step "
      "keep their stiffness, faster ones are softened until the step carries them. 1: the stable "
      "step bounds the step of all.");
  declare_start<dim>(list);
  declare_pinned<dim>(list);
  declare_attachments<dim>(list);
  declare_loads_and_tethers<dim>(list);
  declare_between(list, "Restitution", 0.0, 0.0, 1.0,
                  "Speed after over speed before a collision [1].");
  declare_at_least(list, "Friction", 0.0, 0.0, "Coulomb's coefficient of contacts [1].");
}

template <int dim>
void read_body_start(const ParameterList& list, const std::vector<Point<dim>>& rest,
                     DeformableBody<dim>& body) {
  body.restitution = list.get<double>("Restitution");
  body.friction = list.get<double>("Friction");
  body.integration = read_integration(list);
  body.most_sub_steps = list.get<int>("Most Sub-Steps");
  check_input(body.most_sub_steps == 1 || !is_implicit(body.integration),
              "The solid \"{}\" has \"Most Sub-Steps\" {}, which only explicit elastic forces "
              "take: set its \"Time Integration\" to semi-implicit or explicit, or leave the "
              "sub-steps out.",
              body.name, body.most_sub_steps);
  body.consistent_mass = list.get<std::string>("Mass") == "consistent";
  std::vector<double> node_measure(rest.size(), 0);
  const int n = body.mass_elements.n_corners;
  for (std::size_t k = 0; k < body.mass_elements.nodes.size(); ++k)
    node_measure[body.mass_elements.nodes[k]] += body.element_measure[k / n] / n;
  place<dim>(list, rest, body);
  read_pinned<dim>(list, rest, vector_value<dim>(list, "Position"), body);
  read_attachments<dim>(list, rest, body);
  body.force = read_loads<dim>(list, rest, node_measure, body.name);
  add_tethers(read_tethers<dim>(list, rest, node_measure, body.name), body);
}

template Eigen::Matrix2d start_rotation<2>(const ParameterList&);
template Eigen::Matrix3d start_rotation<3>(const ParameterList&);
template void declare_body_start<2>(ParameterList&, const std::string&);
template void declare_body_start<3>(ParameterList&, const std::string&);
template void read_body_start<2>(const ParameterList&, const std::vector<Point<2>>&,
                                 DeformableBody<2>&);
template void read_body_start<3>(const ParameterList&, const std::vector<Point<3>>&,
                                 DeformableBody<3>&);

}  // namespace lockstep
