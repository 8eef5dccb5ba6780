#include "contact/register_contact.hpp"

#include <algorithm>

#include "base/errors.hpp"
#include "contact/gauss_seidel_contact.hpp"

namespace lockstep {

ParameterList contact_parameters() {
  const GaussSeidelOptions usual;
  ParameterList list;
  declare_positive(list, "Iterations", usual.sweeps,
                   "Sweeps of projected Gauss-Seidel over the final set of contacts, at most; an "
                   "eighth of it while the set grows.");
  declare_tolerance(list, "Tolerance", usual.tolerance,
                    "Sweeps end when velocities at contacts change by less than this part of the "
                    "largest change that contact asks for [1].");
  declare_positive(list, "Margin", usual.margin,
                   "Gap below which surfaces are watched whatever their motion [cells]. Faster "
                   "motion is followed along its path.");
  declare_positive(list, "Slop", usual.slop,
                   "Overlap that is left alone, and gap up to which solids count as touching "
                   "[cells].");
  declare_positive(list, "Shell Thickness", usual.shell_thickness,
                   "Thickness for contact of thin shells and of the skins of deformable bodies "
                   "[cells]. Surfaces that touch stay the mean of their thicknesses apart; of one "
                   "that touches itself it should be below half the spacing of the mesh.");
  ParameterList skin;
  declare_required_positive(skin, "Thickness",
                            "Thickness for contact instead of \"Shell Thickness\" [m].");
  declare_named_sublists(list, "Skins", "Thickness for contact of single solids, by their names.",
                         skin);
  declare_positive(list, "Deepest Overlap", usual.deepest,
                   "Largest depth inside a solid at which a vertex is recognised [cells].");
  declare_between(list, "Push Out Rate", usual.push_rate, 0.0, 1.0,
                  "Part of an overlap beyond the slop that one step removes [1].");
  declare_at_least(list, "Bounce Speed", usual.bounce_speed, 0.0,
                   "Speed of approach below which there is no restitution [m/s].");
  declare(list, "Self-Contact", usual.self_contact,
          "Deformable bodies and cloth touch themselves. Neighbours across one edge of a mesh are "
          "kept from crossing, not apart.");
  declare(list, "Between Jointed Solids", false,
          "Solids that a joint connects touch each other; else they may overlap there.");
  declare_optional<double>(list, "Wall Friction",
                           "Coulomb's coefficient of the domain's walls [1]; without it that of "
                           "the solid counts. Two solids, or a solid and a wall, have the "
                           "geometric mean of their coefficients.");
  declare_optional<double>(list, "Wall Restitution",
                           "Restitution of the domain's walls [1]; without it that of the solid "
                           "counts. Pairs have the geometric mean.");
  set_at_least(list, "Wall Friction", 0);
  set_between(list, "Wall Restitution", 0, 1);
  return list;
}

namespace {

std::optional<double> optional_value(const ParameterList& list, const std::string& name) {
  return list.isParameter(name) ? std::optional<double>(list.get<double>(name)) : std::nullopt;
}

GaussSeidelOptions options_from(const ParameterList& list) {
  GaussSeidelOptions options;
  options.sweeps = list.get<int>("Iterations");
  options.tolerance = list.get<double>("Tolerance");
  options.margin = list.get<double>("Margin");
  options.slop = list.get<double>("Slop");
  options.shell_thickness = list.get<double>("Shell Thickness");
  options.deepest = list.get<double>("Deepest Overlap");
  options.push_rate = list.get<double>("Push Out Rate");
  options.bounce_speed = list.get<double>("Bounce Speed");
  const ParameterList& skins = list.sublist("Skins");
  for (auto skin = skins.begin(); skin != skins.end(); ++skin) {
    const std::string& name = skins.name(skin);
    options.thickness_of[name] = skins.sublist(name).get<double>("Thickness");
  }
  options.self_contact = list.get<bool>("Self-Contact");
  options.wall_friction = optional_value(list, "Wall Friction");
  options.wall_restitution = optional_value(list, "Wall Restitution");
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
               "projected Gauss-Seidel on velocities.",
               contact_parameters,
               [](const ParameterList& list, const ContactSetting<dim>& setting) {
                 GaussSeidelOptions options = options_from(list);
                 check_names(options.thickness_of, setting.solids);
                 if (!list.get<bool>("Between Jointed Solids"))
                   options.apart = setting.jointed;
                 return std::make_unique<GaussSeidelContact<dim>>(
                     options, walls_of<dim>(setting.domain, setting.closed_sides),
                     setting.smallest_length, setting.wall_velocity);
               });
}

template void register_contact<2>(ContactRegistry<2>&);
template void register_contact<3>(ContactRegistry<3>&);

}  // namespace lockstep
