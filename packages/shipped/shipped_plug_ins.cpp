#include "shipped/shipped_plug_ins.hpp"

#include "articulated/register_articulated.hpp"
#include "contact/register_contact.hpp"
#include "cutcell/register_flux.hpp"
#include "deformable/register_deformable.hpp"
#include "lines/register_lines.hpp"
#include "liquid/register_interfaces.hpp"
#include "mac/register_mac.hpp"
#include "mixedface/register_mixed_face.hpp"
#include "observers/register_observers.hpp"
#include "rigid/register_rigid.hpp"
#include "staggered/domain/boundary.hpp"
#include "strategies/register_strategies.hpp"

namespace lockstep {

template <int dim>
std::shared_ptr<InterfaceRegistry<dim>> shipped_interface_models() {
  auto interfaces = std::make_shared<InterfaceRegistry<dim>>("interface model");
  register_interfaces<dim>(*interfaces);
  return interfaces;
}

template <int dim>
Registries<dim> shipped_plug_ins(std::shared_ptr<const InterfaceRegistry<dim>> interfaces) {
  Registries<dim> registries;
  if (!interfaces)
    interfaces = shipped_interface_models<dim>();
  register_mac<dim>(registries.fluids, interfaces);
  registries.domains["mac"] = domain_parameters<dim>;
  register_rigid<dim>(registries.solids);
  register_deformable<dim>(registries.solids);
  register_lines<dim>(registries.solids);
  register_mixed_face<dim>(registries.couplings);
  register_flux<dim>(registries.couplings);
  register_articulated<dim>(registries);
  register_contact<dim>(registries.contacts);
  register_strategies(registries.strategies);
  register_observers<dim>(registries.observers);
  return registries;
}

template std::shared_ptr<InterfaceRegistry<2>> shipped_interface_models<2>();
template std::shared_ptr<InterfaceRegistry<3>> shipped_interface_models<3>();
template Registries<2> shipped_plug_ins<2>(std::shared_ptr<const InterfaceRegistry<2>>);
template Registries<3> shipped_plug_ins<3>(std::shared_ptr<const InterfaceRegistry<3>>);

}  // namespace lockstep
