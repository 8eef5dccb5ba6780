#include "contact/register_contact.hpp"

#include <algorithm>

#include "base/errors.hpp"
#include "contact/gauss_seidel_contact.hpp"

namespace lockstep {

ParameterList contact_parameters() {
  const GaussSeidelOptions usual;
  ParameterList list;
  declare_positive(list, "Maximum Iterations", usual.sweeps,
                   "Sweeps of block Gauss-Seidel over the final set of contacts, at most; an "
                   "eighth of it while the set grows.");
  declare_tolerance(list, "Tolerance", usual.tolerance,
                    "Sweeps end when velocities at contacts change by less than this part of the "
                    "largest change that contact asks for [1].");
  declare_positive(list, "Thickness", usual.thickness,
                   "Thickness for contact of thin shells and of the skins of deformable bodies "
                   "[cells]. Surfaces that touch stay the mean of their thicknesses apart; of one "
                   "that touches itself it should be below half the spacing of the mesh.");
  ParameterList skin;
  declare_required_positive(skin, "Thickness", "Instead of that of all [m].");
  declare_named_sublists(list, "Skins", "By name of a solid: its own thickness for contact.", skin);
  ParameterList& walls = declare_list(list, "Walls", "The closed sides of the domain.");
  declare_optional<double>(walls, "Friction",
                           "Coulomb's coefficient of the walls [1]; without it that of the solid "
                           "counts. Two solids, or a solid and a wall, have the geometric mean of "
                           "their coefficients.");
  declare_optional<double>(walls, "Restitution",
                           "Restitution of the walls [1]; without it that of the solid counts. "
                           "Pairs have the geometric mean.");
  set_at_least(walls, "Friction", 0);
  set_between(walls, "Restitution", 0, 1);
  return list;
}

namespace {

std::optional<double> optional_value(const ParameterList& list, const std::string& name) {
  return list.isParameter(name) ? std::optional<double>(list.get<double>(name)) : std::nullopt;
}

GaussSeidelOptions options_from(const ParameterList& list) {
  GaussSeidelOptions options;
  options.sweeps = list.get<int>("Maximum Iterations");
  options.tolerance = list.get<double>("Tolerance");
  options.thickness = list.get<double>("Thickness");
  const ParameterList& skins = list.sublist("Skins");
  for (auto skin = skins.begin(); skin != skins.end(); ++skin) {
    const std::string& name = skins.name(skin);
    options.thickness_of[name] = skins.sublist(name).get<double>("Thickness");
  }
  options.wall_friction = optional_value(list.sublist("Walls"), "Friction");
  options.wall_restitution = optional_value(list.sublist("Walls"), "Restitution");
  return options;
}

void check_names(const std::map<std::string, double>& by_name,
                 const std::vector<std::string>& solids) {
  for (const auto& [name, value] : by_name) {
    check_input(std::find(solids.begin(), solids.end(), name) != solids.end(),
                "\"Contact/Skins/{0}\": there is no solid \"{0}\"; name one of \"Solids\".", name);
  }
}

}  // namespace

template <int dim>
void register_contact(ContactRegistry<dim>& contacts) {
  contacts.add("gauss seidel",
               "Collisions, resting contact and Coulomb friction between solids and with walls, by "
               "block Gauss-Seidel on velocities.",
               contact_parameters,
               [](const ParameterList& list, const ContactSetting<dim>& setting) {
                 GaussSeidelOptions options = options_from(list);
                 check_names(options.thickness_of, setting.solids);
                 options.apart = setting.jointed;
                 return std::make_unique<GaussSeidelContact<dim>>(
                     options, walls_of<dim>(setting.domain, setting.closed_sides),
                     setting.smallest_length, setting.wall_velocity);
               });
}

template void register_contact<2>(ContactRegistry<2>&);
template void register_contact<3>(ContactRegistry<3>&);

}  // namespace lockstep
