#include "freesurface/register_freesurface.hpp"

#include "freesurface/level_set.hpp"

namespace lockstep {

template <int dim>
void register_freesurface(InterfaceRegistry<dim>& interfaces) {
  interfaces.add("level set", "A distance carried on the grid alone: rounds off what is thin.",
                 level_set_parameters<dim>,
                 [](const ParameterList& list, const MacDomain<dim>& domain) {
                   return std::make_unique<LevelSet<dim>>(domain, read_level_set_parameters(list));
                 });
}

template void register_freesurface<2>(InterfaceRegistry<2>&);
template void register_freesurface<3>(InterfaceRegistry<3>&);

}  // namespace lockstep
