#include "articulated/register_articulated.hpp"

#include "articulated/joint_parameters.hpp"
#include "articulated/joint_rates.hpp"

namespace lockstep {

template <int dim>
void register_articulated(Registries<dim>& registries, const JointTypes<dim>& types) {
  const char* const name = "reduced coordinates";
  registries.articulations.add(
      name, "Bodies move as their joints let them, exactly, in every solve.",
      articulation_parameters,
      [types](const ParameterList& list, const NamedLists& joints,
              const JointSetting<dim>& setting) {
        const auto articulation = read_joints<dim>(list, joints, setting, types);
        auto system = std::make_unique<JointSystem<dim>>();
        system->constraints = std::make_unique<JointConstraints<dim>>(articulation, setting.comm);
        system->rates =
            std::make_unique<JointRates<dim>>(articulation, setting.comm, setting.start_time);
        return system;
      });
  registries.joints[name] = [types] { return types.joints->schemas(*types.targets); };
}

template void register_articulated<2>(Registries<2>&, const JointTypes<2>&);
template void register_articulated<3>(Registries<3>&, const JointTypes<3>&);

}  // namespace lockstep
