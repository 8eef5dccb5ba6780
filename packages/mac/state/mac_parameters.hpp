#pragma once
#include "liquid/liquid_parameters.hpp"
#include "mac/forces/forces.hpp"
#include "mac/viscosity/viscosity.hpp"
#include "parameters/parameter_list.hpp"
#include "transport/transport.hpp"

namespace lockstep {

/// The numbers of a fluid, read once.
template <int dim>
struct MacParameters {
  double density = 1000;  ///< density, that of the liquid if there is a gas, too [kg/m^dim]
  Phases phases;
  ViscosityParameters viscosity;
  ForceParameters<dim> forces;
  AdvectionScheme advection = AdvectionScheme::semi_lagrangian;
  int order_in_time = 1;  ///< order of the splitting of advection from all else
};

/// Schema of the "Fluid" list, without "Type"; without interface models it knows no free surface.
template <int dim>
ParameterList mac_parameters(const InterfaceRegistry<dim>* interfaces = nullptr);
template <int dim>
MacParameters<dim> read_mac_parameters(const ParameterList& fluid);

}  // namespace lockstep
