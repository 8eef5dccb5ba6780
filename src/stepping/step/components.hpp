#pragma once
#include <memory>
#include <string>

#include "coupling/solid_system.hpp"
#include "coupling/solid_totals.hpp"
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
        viscous_coupling(components.coupling->viscosity()),
        audited_coupling(components.coupling->audit()),
        hydrostatic_coupling(components.coupling->hydrostatics()),
        gas_fluid(components.fluid->gas()),
        gas_coupling(components.coupling->gas()),
        audited(audited_fluid && audited_coupling && is_audited(*components.solids)) {}

  ViscousFluid<dim>* viscous_fluid;
  const AuditedFluid<dim>* audited_fluid;
  const ViscousCoupling<dim>* viscous_coupling;
  const AuditedCoupling<dim>* audited_coupling;
  const HydrostaticCoupling<dim>* hydrostatic_coupling;
  GasFluid<dim>* gas_fluid;
  const GasCoupling<dim>* gas_coupling;
  bool audited;  ///< all that the momentum ledger asks
};

}  // namespace lockstep
