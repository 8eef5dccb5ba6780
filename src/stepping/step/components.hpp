#pragma once
#include <memory>
#include <string>

#include "coupling/solid_system.hpp"
#include "interfaces/contact.hpp"
#include "interfaces/coupling_sides.hpp"
#include "interfaces/fluid_sides.hpp"
#include "interfaces/gas.hpp"
#include "interfaces/strategy.hpp"
#include "interfaces/viscosity.hpp"

namespace lockstep {

/// The plug-ins of a scene.
template <int dim>
struct Components {
  std::unique_ptr<FluidDiscretization<dim>> fluid;
  std::unique_ptr<SolidSystem<dim>> solids;
  std::unique_ptr<Coupling<dim>> coupling;
  std::string coupling_note;  ///< reason of a coupling that the scene left to the program
  std::unique_ptr<SolverStrategy> strategy;
  std::unique_ptr<ContactModel<dim>> contact;  ///< null: solids do not touch
};

/// Calls f(plug_in) for all of them.
template <int dim, typename Function>
void for_each_plug_in(Components<dim>& components, const Function& f) {
  for (int m = 0; m < components.solids->n_models(); ++m)
    f(components.solids->model(m));
  if (ConstraintModel* joints = components.solids->joints())
    f(*joints);
  f(*components.fluid);
  f(*components.coupling);
  f(*components.strategy);
  if (components.contact)
    f(*components.contact);
}

/// The sides that a step makes use of; null where a plug-in does without.
template <int dim>
struct ComponentSides {
  explicit ComponentSides(const Components<dim>& components)
      : viscous_fluid(components.fluid->viscosity()),
        audited_fluid(components.fluid->audit()),
        viscous_coupling(side_of<ViscousCoupling<dim>>(*components.coupling)),
        audited_coupling(side_of<AuditedCoupling<dim>>(*components.coupling)),
        hydrostatic_coupling(side_of<HydrostaticCoupling<dim>>(*components.coupling)),
        gas_fluid(components.fluid->gas()),
        gas_coupling(side_of<GasCoupling<dim>>(*components.coupling)),
        audited(audited_fluid && audited_coupling && components.solids->is_audited()) {}

  ViscousFluid<dim>* viscous_fluid;
  const AuditedFluid<dim>* audited_fluid;
  const ViscousCoupling<dim>* viscous_coupling;
  const AuditedCoupling<dim>* audited_coupling;
  const HydrostaticCoupling<dim>* hydrostatic_coupling;
  GasFluid<dim>* gas_fluid;
  GasCoupling<dim>* gas_coupling;
  bool audited;  ///< all that the momentum ledger asks
};

}  // namespace lockstep
