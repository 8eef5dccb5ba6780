#include "deformable/register_deformable.hpp"

#include "deformable/deformable_parameters.hpp"
#include "deformable/deformable_solids.hpp"

namespace lockstep {

template <int dim>
void register_deformable(SolidRegistry<dim>& solids) {
  solids.add("deformable body", "Elastic volume of triangles (2D) or tetrahedra (3D).",
             deformable_body_parameters<dim>,
             [](const ParameterList&, const NamedLists& lists,
                const SolidSetting<dim>& setting) -> std::unique_ptr<SolidModel<dim>> {
               if (lists.empty())
                 return nullptr;
               std::vector<DeformableBody<dim>> bodies;
               for (const auto& [name, list] : lists)
                 bodies.push_back(read_deformable_body<dim>(name, list, setting.grid_spacing));
               return std::make_unique<DeformableSolids<dim>>(std::move(bodies), setting.gravity,
                                                              setting.comm);
             });
}

template void register_deformable<2>(SolidRegistry<2>&);
template void register_deformable<3>(SolidRegistry<3>&);

}  // namespace lockstep
