#pragma once
#include <algorithm>
#include <optional>

#include "liquid/common/interface_model.hpp"
#include "liquid/gas/gas_bubbles.hpp"
#include "parameters/parameter_list.hpp"

namespace lockstep {

/// One of two incompressible fluids.
struct Phase {
  double density = 0;    ///< [kg/m^dim]
  double viscosity = 0;  ///< dynamic [Pa s]
};

struct Phases {
  Phase liquid;
  std::optional<Phase> gas;             ///< fluid above the surface; none: air without mass, p = 0
  bool transport_is_consistent = true;  ///< mass and momentum near the surface by one flux
  double largest_viscosity() const {
    return std::max(liquid.viscosity, gas ? gas->viscosity : 0.0);
  }
};

/// Declares the list "Phases" of a fluid.
void declare_phases(ParameterList& fluid);
/// Reads a validated list "Fluid". Throws InputError if phases contradict other parameters.
Phases read_phases(const ParameterList& fluid);

/// Parameters of a free surface, beside those of its interface model.
struct FreeSurfaceParameters {
  int pressure_order = 2;
  double tension = 0;  ///< surface tension [N/m]
  bool tension_is_implicit = false;
};

/// Declares the list "Free Surface" of a fluid.
template <int dim>
void declare_free_surface(const InterfaceRegistry<dim>& interfaces, ParameterList& fluid);
/// Validated list "Free Surface".
FreeSurfaceParameters read_free_surface(const ParameterList& list);
/// Reads the union of the liquids of a validated list "Fluid" with a "Free Surface"; for a tank
/// that sources are to fill it is far away. Throws InputError if there is neither liquid nor a
/// source of it, or a level without gravity.
template <int dim>
SignedDistance<dim> read_liquid(const ParameterList& fluid, const Point<dim>& gravity);
/// Reads the parameters of trapped air from a validated list "Fluid". Throws InputError if numbers
/// are missing, or tiles move.
template <int dim>
GasParameters<dim> read_gas(const ParameterList& fluid);
/// Throws InputError if numbers are missing.
template <int dim>
std::vector<Point<dim>> read_dry_points(const ParameterList& list);
/// Shapes whose liquid is taken away.
template <int dim>
std::vector<SignedDistance<dim>> read_sinks(const ParameterList& list);
/// Throws InputError if the fluid's list has parameters that exclude a free surface. `periodic`:
/// the axes of the domain that are.
template <int dim>
void check_free_surface(const ParameterList& fluid, const Point<dim>& gravity,
                        const std::array<bool, dim>& periodic);

}  // namespace lockstep
