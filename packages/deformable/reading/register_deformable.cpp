#include "deformable/reading/register_deformable.hpp"

#include "deformable/deformable_solids.hpp"
#include "deformable/reading/deformable_parameters.hpp"

namespace lockstep {

namespace {

/// One model of all bodies of a type.
template <int dim, typename Read>
std::unique_ptr<SolidModel<dim>> make_model(const std::string& type, const Read& read,
                                            const NamedLists& lists,
                                            const SolidSetting<dim>& setting) {
  if (lists.empty())
    return nullptr;
  std::vector<DeformableBody<dim>> bodies;
  for (const auto& [name, list] : lists) {
    bodies.push_back(read(name, list));
    bodies.back().fluid_density =
        setting.fluid_density * (bodies.back().closed ? 1 : setting.smallest_length);
  }
  return std::make_unique<DeformableSolids<dim>>(type, bodies, setting.gravity, setting.comm,
                                                 setting.start_time);
}

}  // namespace

template <int dim>
void register_deformable(SolidRegistry<dim>& solids,
                         const std::shared_ptr<const MaterialRegistry<dim>>& materials) {
  solids.add(
      "deformable body", "Elastic volume of triangles (2D) or tetrahedra (3D).",
      [materials] { return deformable_body_parameters<dim>(*materials); },
      [materials](const ParameterList&, const NamedLists& lists, const SolidSetting<dim>& setting) {
        const auto read = [&](const std::string& name, const ParameterList& list) {
          return read_deformable_body<dim>(name, list, setting.smallest_length,
                                           setting.gravity.norm(), *materials);
        };
        return make_model<dim>("deformable body", read, lists, setting);
      });
  solids.add("cloth",
             "Elastic thin shell of segments (2D) or triangles (3D): membrane and bending.",
             cloth_parameters<dim>,
             [](const ParameterList&, const NamedLists& lists, const SolidSetting<dim>& setting) {
               const auto read = [&setting](const std::string& name, const ParameterList& list) {
                 return read_cloth<dim>(name, list, setting.smallest_length);
               };
               return make_model<dim>("cloth", read, lists, setting);
             });
}

template void register_deformable<2>(SolidRegistry<2>&,
                                     const std::shared_ptr<const MaterialRegistry<2>>&);
template void register_deformable<3>(SolidRegistry<3>&,
                                     const std::shared_ptr<const MaterialRegistry<3>>&);

}  // namespace lockstep
