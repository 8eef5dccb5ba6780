#include "rigid/register_rigid.hpp"

#include "rigid/rigid_bodies.hpp"
#include "rigid/rigid_parameters.hpp"

namespace lockstep {

template <int dim>
void register_rigid(SolidRegistry<dim>& solids) {
  solids.add("rigid body", "Rigid volume or rigid thin shell, dynamic or moved by a script.",
             rigid_body_parameters<dim>,
             [](const ParameterList&, const NamedLists& bodies, const SolidSetting<dim>& setting) {
               return make_rigid_bodies<dim>(bodies, setting.smallest_length, setting.gravity,
                                             setting.comm, setting.start_time);
             });
}

template void register_rigid<2>(SolidRegistry<2>&);
template void register_rigid<3>(SolidRegistry<3>&);

}  // namespace lockstep
