#include "rigid/body_mass.hpp"

#include <Eigen/Eigenvalues>

#include "base/errors.hpp"
#include "base/round_off.hpp"
#include "motion/list_values.hpp"

namespace lockstep {

namespace {

/// Returns whether a list gives the density of a volume; it may not give that of a shell.
template <int dim>
bool has_volume_density(const ParameterList& list, const RigidBodyConstants<dim>& body) {
  for (const char* other : {"Surface Density", "Thickness"}) {
    check_input(!list.isParameter(other),
                "The solid \"{}\" is a volume, so it has no \"{}\"; give \"Density\" or \"Mass\".",
                body.name, other);
  }
  return list.isParameter("Density");
}

/// Returns whether a list gives the mass of a shell per area: itself, or by its thickness and the
/// density of what it is made of.
template <int dim>
bool has_shell_density(const ParameterList& list, const RigidBodyConstants<dim>& body) {
  const bool direct = list.isParameter("Surface Density"), density = list.isParameter("Density"),
             thickness = list.isParameter("Thickness");
  check_input(
      !direct || !(density || thickness),
      "The solid \"{}\" has both \"Surface Density\" and \"{}\"; leave out one: \"Thickness\" "
      "times \"Density\" takes the place of \"Surface Density\".",
      body.name, density ? "Density" : "Thickness");
  check_input(density == thickness,
              "The solid \"{}\" is a thin shell with a \"{}\", but has no \"{}\"; give both, "
              "\"Surface Density\" or \"Mass\".",
              body.name, density ? "Density" : "Thickness", density ? "Thickness" : "Density");
  return direct || density;
}

/// Density per unit of measure (volume or surface), the mean one if the mass is given; 0 for a
/// prescribed body that names none.
template <int dim>
double read_density(const ParameterList& list, const RigidBodyConstants<dim>& body,
                    double measure) {
  const bool by_density =
      body.closed ? has_volume_density(list, body) : has_shell_density(list, body);
  const bool by_mass = list.isParameter("Mass"), by_volume = list.isParameter("Density");
  const std::string wanted = body.closed || by_volume ? "Density" : "Surface Density";
  check_input(!(by_density && by_mass),
              "The solid \"{}\" has both \"{}\" and \"Mass\"; leave out one.", body.name, wanted);
  check_input(by_density || by_mass || body.script,
              "The solid \"{}\" has no mass; give \"{}\" or \"Mass\".", body.name, wanted);
  if (by_mass)
    return list.get<double>("Mass") / measure;
  if (!by_density)
    return 0;
  const double density = list.get<double>(wanted);
  return by_volume && !body.closed ? density * list.get<double>("Thickness") : density;
}

/// A mass that is not spread evenly has nothing to do with the density of a volume.
template <int dim>
void check_own_mass(const ParameterList& list, const RigidBodyConstants<dim>& body) {
  for (const char* parameter : {"Center of Mass", "Inertia"}) {
    if (!list.isParameter(parameter))
      continue;
    check_input(!body.script,
                "The solid \"{}\" follows a script, so it has no \"{}\"; leave it out, or make its "
                "motion \"dynamic\".",
                body.name, parameter);
    check_input(
        list.isParameter("Mass"),
        "The solid \"{}\" has a \"{}\" of its own, but no \"Mass\"; give that in place of a "
        "density.",
        body.name, parameter);
  }
}

/// Returns the inertia about the centre of mass that a list gives [kg m^2].
template <int dim>
Inertia<dim> read_inertia(const ParameterList& list, const std::string& name) {
  if constexpr (dim == 2) {
    return Inertia<2>(list.get<double>("Inertia"));
  } else {
    const auto& values = list.get<ParameterArray<double>>("Inertia");
    check_input(values.size() == 3 || values.size() == 6,
                "The \"Inertia\" of the solid \"{}\" has {} numbers; give three moments, or six "
                "numbers of a tensor: xx, yy, zz, xy, xz, yz.",
                name, values.size());
    Inertia<3> tensor = Inertia<3>::Zero();
    for (int a = 0; a < 3; ++a)
      tensor(a, a) = values[a];
    if (values.size() == 6) {
      tensor(0, 1) = tensor(1, 0) = values[3];
      tensor(0, 2) = tensor(2, 0) = values[4];
      tensor(1, 2) = tensor(2, 1) = values[5];
    }
    const Point<3> moments = Eigen::SelfAdjointEigenSolver<Inertia<3>>(tensor).eigenvalues();
    check_input(moments[0] > 0,
                "The \"Inertia\" of the solid \"{}\" has a principal moment of {:g} kg m^2; all "
                "must be greater than 0.",
                name, moments[0]);
    check_input(moments[0] + moments[1] >= (1 - rounding::differences) * moments[2],
                "The \"Inertia\" of the solid \"{}\" has the principal moments {:g}, {:g} and {:g} "
                "kg m^2, but no mass has one that is larger than the sum of the others.",
                name, moments[0], moments[1], moments[2]);
    return tensor;
  }
}

}  // namespace

template <int dim>
void declare_mass(ParameterList& body) {
  declare_optional<double>(
      body, "Density",
      "Density of a volume, or of what a thin shell is made of [kg/m^3] (2D: [kg/m^2]). A dynamic "
      "body needs one of density and mass.");
  declare_optional<double>(body, "Surface Density",
                           "Mass per area of a thin shell [kg/m^2] (2D: [kg/m]).");
  declare_optional<double>(body, "Thickness",
                           "Thickness of a thin shell [m], to which the fluid is blind: "
                           "\"Thickness\" times \"Density\" is its mass per area, in place of "
                           "\"Surface Density\".");
  declare_optional<double>(body, "Mass",
                           "Mass [kg] (2D: per unit depth), spread evenly but for what \"Center of "
                           "Mass\" and \"Inertia\" say.");
  declare_optional<ParameterArray<double>>(
      body, "Center of Mass",
      "Centre of the \"Mass\", in coordinates of the body [m]: of ballast, of a hollow hull. "
      "Default: that of a mass spread evenly.");
  set_length(body, "Center of Mass", dim);
  if constexpr (dim == 2) {
    declare_optional<double>(
        body, "Inertia",
        "Moment of inertia of the \"Mass\" about its centre [kg m^2] (per unit "
        "depth). Default: that of a mass spread evenly, about its own centre.");
    set_positive(body, "Inertia");
  } else {
    declare_optional<ParameterArray<double>>(
        body, "Inertia",
        "Inertia of the \"Mass\" about its centre [kg m^2]: three moments about the axes of the "
        "body, or the tensor in them, xx, yy, zz, xy, xz, yz (off the diagonal minus the integral "
        "of x y). Default: that of a mass spread evenly, about its own centre.");
  }
  for (const char* name : {"Density", "Surface Density", "Thickness", "Mass"})
    set_positive(body, name);
}

template <int dim>
Point<dim> set_mass(RigidBodyConstants<dim>& body, const ParameterList& list) {
  check_own_mass<dim>(list, body);
  const MassProperties<dim> properties =
      body.closed ? volume_properties(body.surface) : shell_properties(body.surface);
  body.density = read_density(list, body, properties.measure);
  body.volume = body.closed ? properties.measure : 0;
  if (!body.script) {
    body.mass = body.density * properties.measure;
    body.inertia = list.isParameter("Inertia") ? read_inertia<dim>(list, body.name)
                                               : body.density * properties.inertia;
  }
  Point<dim> center = properties.centroid;
  if (list.isParameter("Center of Mass"))
    center = vector_value<dim>(list, "Center of Mass");
  Point<dim> reference = center;
  if (list.isParameter("Pivot"))
    reference = vector_value<dim>(list, "Pivot");
  body.center_of_mass = center - reference;
  for (auto& vertex : body.surface.vertices)
    vertex -= reference;
  return reference;
}

template void declare_mass<2>(ParameterList&);
template void declare_mass<3>(ParameterList&);
template Point<2> set_mass<2>(RigidBodyConstants<2>&, const ParameterList&);
template Point<3> set_mass<3>(RigidBodyConstants<3>&, const ParameterList&);

}  // namespace lockstep
