#include "deformable/deformable_parameters.hpp"

#include <Eigen/Geometry>

#include "base/errors.hpp"
#include "deformable/body_mesh.hpp"
#include "deformable/elements/volume_elements.hpp"
#include "deformable/list_values.hpp"
#include "deformable/node_region.hpp"

namespace lockstep {

namespace {

using deformable_lists::vector_value;

template <int dim>
using Rotation = Eigen::Matrix<double, dim, dim>;

void declare_material(ParameterList& body) {
  ParameterList law("law");
  declare_required_positive(law, "Young's Modulus", "Stiffness in uniaxial stress [Pa].");
  declare_between(law, "Poisson's Ratio", 0.3, -0.99, 0.4999,
                  "Contraction across over stretch along [1]. In 2D strain is plane. Near 0.5 "
                  "linear elements lock: refine, or stay below 0.45.");
  std::vector<TypedSchema> laws;
  for (const MaterialName& material : material_names())
    laws.push_back({material.name, material.documentation, law});
  declare_typed_sublist(body, "Material", "The elastic law.", laws, "corotated");
}

void declare_damping(ParameterList& body) {
  declare_at_least(body, "Viscosity", 0.0, 0.0,
                   "Of the material: shear stress over twice the strain rate [Pa s].");
  declare_at_least(body, "Stiffness Damping", 0.0, 0.0,
                   "Rayleigh's factor of the stiffness at rest [s]: a mode of angular frequency w "
                   "has w/2 times this of critical damping.");
}

template <int dim>
void declare_start(ParameterList& body) {
  declare_vector(body, "Position", ParameterArray<double>(dim, 0.0), dim,
                 "Where the origin of the body's coordinates lies at the start [m].");
  if constexpr (dim == 2) {
    declare(body, "Rotation", 0.0,
            "Angle by which the body is turned about that origin at the start [rad].");
    declare(body, "Angular Velocity", 0.0, "About that origin at the start [rad/s].");
  } else {
    declare_vector(body, "Rotation", {0.0, 0.0, 0.0}, 3,
                   "Rotation vector (axis times angle) by which the body is turned about that "
                   "origin at the start [rad].");
    declare_vector(body, "Angular Velocity", {0.0, 0.0, 0.0}, 3,
                   "About that origin at the start [rad/s].");
  }
  declare_vector(body, "Velocity", ParameterArray<double>(dim, 0.0), dim,
                 "Of that origin at the start [m/s].");
  declare_vector(body, "Stretch", ParameterArray<double>(dim, 1.0), dim,
                 "Factors along the body's axes by which it is stretched at the start, before it "
                 "is turned [1].");
  set_positive(body, "Stretch");
}

template <int dim>
Rotation<dim> read_rotation(const ParameterList& list) {
  if constexpr (dim == 2) {
    return Eigen::Rotation2Dd(list.get<double>("Rotation")).toRotationMatrix();
  } else {
    const Point<3> turn = vector_value<3>(list, "Rotation");
    const double angle = turn.norm();
    return angle == 0 ? Rotation<3>(Rotation<3>::Identity())
                      : Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix();
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
  const Rotation<dim> rotation = read_rotation<dim>(list);
  for (const Point<dim>& x : rest) {
    const Point<dim> arm = rotation * x.cwiseProduct(stretch);
    body.position.push_back(origin + arm);
    body.velocity.push_back(velocity + rotate<dim>(angular_velocity, arm));
  }
}

TimeIntegration read_integration(const ParameterList& list) {
  const auto& name = list.get<std::string>("Time Integration");
  if (name == "explicit")
    return TimeIntegration::explicit_forces;
  return name == "semi-implicit" ? TimeIntegration::semi_implicit : TimeIntegration::fully_implicit;
}

}  // namespace

template <int dim>
ParameterList deformable_body_parameters() {
  ParameterList list("deformable body");
  declare_deformable_geometry<dim>(list);
  declare_material(list);
  declare_required_positive(list, "Density", "At rest [kg/m^3] (2D: [kg/m^2]).");
  declare_choice(list, "Mass", "lumped", {"lumped", "consistent"},
                 "lumped: a share of each element on its corners. consistent: the mass matrix of "
                 "the finite elements.");
  declare_damping(list);
  declare_choice(
      list, "Time Integration", "semi-implicit", {"explicit", "semi-implicit", "fully-implicit"},
      "explicit: all forces at the present state. semi-implicit: elastic forces at the "
      "present positions, implicit damping. fully-implicit: both linearised and solved "
      "together with the fluid; stable at any step. The step of the others is bounded by "
      "the stiffest element.");
  declare_start<dim>(list);
  declare_constraints_and_loads<dim>(list);
  declare_between(list, "Restitution", 0.0, 0.0, 1.0,
                  "Speed after over speed before a collision [1].");
  declare_at_least(list, "Friction", 0.0, 0.0, "Coulomb's coefficient of contacts [1].");
  return list;
}

template <int dim>
DeformableBody<dim> read_deformable_body(const std::string& name, const ParameterList& list,
                                         double grid_spacing) {
  const VolumeMesh<dim> mesh = make_body_mesh<dim>(list.sublist("Geometry"), grid_spacing, name);
  DeformableBody<dim> body;
  body.name = name;
  body.density = list.get<double>("Density");
  body.restitution = list.get<double>("Restitution");
  body.friction = list.get<double>("Friction");
  body.integration = read_integration(list);
  body.consistent_mass = list.get<std::string>("Mass") == "consistent";

  const ParameterList& material = list.sublist("Material");
  const LameConstants lame = lame_constants(material.get<double>("Young's Modulus"),
                                            material.get<double>("Poisson's Ratio"));
  const double factor = list.get<double>("Stiffness Damping");
  const StrainRateDamping damping{list.get<double>("Viscosity") + factor * lame.mu,
                                  factor * lame.lambda};
  body.elements.push_back(volume_elements<dim>(
      mesh, make_material<dim>(material.get<std::string>("Type"), lame), damping));

  body.mass_elements = body.elements.back()->corners();
  std::vector<double> node_mass(mesh.vertices.size(), 0);
  for (int e = 0; e < static_cast<int>(mesh.elements.size()); ++e) {
    body.element_mass.push_back(body.density * element_volume(mesh, e));
    for (const int v : mesh.elements[e])
      node_mass[v] += body.element_mass.back() / (dim + 1);
  }

  BoundarySurface<dim> boundary = extract_surface(mesh, name);
  check_surface(boundary.surface, true, name);
  for (auto simplex : boundary.surface.simplices) {
    for (int& corner : simplex)
      corner = boundary.vertices[corner];
    body.surface.push_back(simplex);
  }
  place<dim>(list, mesh.vertices, body);
  body.locked = read_pinned<dim>(list, mesh.vertices, name);
  body.force = read_loads<dim>(list, mesh.vertices, node_mass, name);
  return body;
}

template ParameterList deformable_body_parameters<2>();
template ParameterList deformable_body_parameters<3>();
template DeformableBody<2> read_deformable_body<2>(const std::string&, const ParameterList&,
                                                   double);
template DeformableBody<3> read_deformable_body<3>(const std::string&, const ParameterList&,
                                                   double);

}  // namespace lockstep
