#include "liquid/register_interfaces.hpp"

#include "liquid/fractions/volume_of_fluid.hpp"
#include "liquid/particles/level_set.hpp"

namespace lockstep {

template <int dim>
void register_interfaces(InterfaceRegistry<dim>& interfaces) {
  const auto make = [](const ParameterList& list, const MacDomain<dim>& domain) {
    return std::make_unique<LevelSet<dim>>(domain, read_level_set_parameters(list));
  };
  interfaces.add("particle level set",
                 "A distance carried on the grid, which particles on both sides of the surface "
                 "correct: keeps what is thin (Enright et al. 2002).",
                 particle_level_set_parameters<dim>, make);
  interfaces.add("level set", "A distance carried on the grid alone: rounds off what is thin.",
                 level_set_parameters<dim>, make);
  interfaces.add(
      "volume of fluid",
      "The part of each cell that is liquid, moved by what passes its faces: loses "
      "nothing but to round-off (Weymouth & Yue 2010).",
      volume_of_fluid_parameters, [](const ParameterList& list, const MacDomain<dim>& domain) {
        return std::make_unique<VolumeOfFluid<dim>>(domain, read_volume_of_fluid_parameters(list));
      });
}

template void register_interfaces<2>(InterfaceRegistry<2>&);
template void register_interfaces<3>(InterfaceRegistry<3>&);

}  // namespace lockstep
