#include "shipped/shipped_plug_ins.hpp"

#include "articulated/register_articulated.hpp"
#include "contact/register_contact.hpp"
#include "cutcell/register_flux.hpp"
#include "deformable/reading/register_deformable.hpp"
#include "lines/register_lines.hpp"
#include "liquid/register_interfaces.hpp"
#include "mac/register_mac.hpp"
#include "mixedface/register_mixed_face.hpp"
#include "observers/register_observers.hpp"
#include "rigid/register_rigid.hpp"
#include "staggered/domain/boundary.hpp"
#include "strategies/register_strategies.hpp"

namespace lockstep {
namespace {

template <int dim>
Registries<dim> shipped() {
  Registries<dim> registries;
  const auto interfaces = registries.template add_part<InterfaceRegistry<dim>>("interface model");
  register_interfaces<dim>(*interfaces);
  register_mac<dim>(registries.fluids, interfaces);
  registries.domains["mac"] = domain_parameters<dim>;
  register_rigid<dim>(registries.solids);
  const auto materials = registries.template add_part<MaterialRegistry<dim>>("material");
  register_materials<dim>(*materials);
  register_deformable<dim>(registries.solids, materials);
  register_lines<dim>(registries.solids);
  register_mixed_face<dim>(registries.couplings);
  register_flux<dim>(registries.couplings);
  const auto joints = registries.template add_part<JointRegistry<dim>>("joint");
  register_joints<dim>(*joints);
  const auto targets = registries.template add_part<TargetRegistry>("target");
  register_targets(*targets);
  register_articulated<dim>(registries, {joints, targets});
  register_contact<dim>(registries.contacts);
  register_strategies(registries.strategies);
  register_observers<dim>(registries.observers);
  return registries;
}

}  // namespace

PlugIns shipped_plug_ins() {
  return {shipped<2>(), shipped<3>()};
}

}  // namespace lockstep
