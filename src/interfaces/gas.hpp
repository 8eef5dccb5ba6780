#pragma once
#include <vector>

#include "interfaces/coupling.hpp"

namespace lockstep {

/// A closed pocket of gas beside a liquid. It has no mass and one pressure, which pushes on all
/// that is around it. Global.
struct GasPocket {
  double volume = 0;     ///< [m^dim]
  double pressure = 0;   ///< above that of the void: what its volume makes it, or of the last step
                         ///< if it keeps its volume [Pa]
  double stiffness = 0;  ///< -dp/dV [Pa/m^dim]; unused if it keeps its volume
  bool keeps_volume = false;
  double missing = 0;  ///< of its volume, to be made good within the step [m^dim]
};

/// A side of fluids with pockets of gas; those of the frozen geometry, in any step the same
/// on all ranks. What one number a pocket is in these calls is named by `PressureSide::pocket`.
template <int dim>
class GasFluid {
 public:
  virtual ~GasFluid() = default;
  virtual const std::vector<GasPocket>& gas_pockets() const = 0;
  /// rhs += what scaled pressures of the pockets, p̂ = dt p, push out of the pressure unknowns
  /// beside them [m^dim/s]. Local.
  virtual void add_gas_push(const std::vector<double>& scaled_pressure, Vector& rhs) const = 0;
  /// By pocket, what a unit of its p̂ opens of it if no unknown answers: the sum of what
  /// `add_gas_push` makes of it. Collective.
  virtual std::vector<double> gas_conductance() const = 0;
  /// The rate at which the free faces open each pocket [m^dim/s]: of u*, less what these pressures
  /// of the unknowns take. Collective.
  virtual std::vector<double> gas_rates() const = 0;
  virtual std::vector<double> gas_answer(const Vector& scaled_pressure) const = 0;
  /// `FluidDiscretization::project`, which finds no pressure in the pockets, with theirs.
  /// Collective.
  virtual void project(const Vector& scaled_pressure, const std::vector<double>& gas_pressure) = 0;
  /// Impulse that the sides of the domain give through the pockets beside them. Collective.
  virtual Momentum<dim> gas_side_impulse(const std::vector<double>& scaled_pressure) const = 0;
};

/// Side interface of couplings: gas pushes on the solids around it. `AuditedCoupling` counts it.
template <int dim>
class GasCoupling {
 public:
  virtual ~GasCoupling() = default;
  /// momentum += what p̂ of the pockets gives dynamic solids [kg m/s]. Collective.
  virtual void add_gas_push(const std::vector<double>& scaled_pressure, Vector& momentum) const = 0;
  /// By pocket, the sum of the magnitudes that a unit of its p̂ gives all dofs, before any cancel:
  /// the scale of the round-off of `add_gas_push`. Collective.
  virtual std::vector<double> gas_push_size(int n_pockets) const = 0;
  /// The rate at which coupled volumes of these velocities open each pocket [m^dim/s]. Collective.
  virtual std::vector<double> gas_rates(const std::vector<double>& coupled_velocity,
                                        int n_pockets) const = 0;
  /// W V_S of the closed parts, for `gas_rates`; with what prescribed solids add to it. Collective.
  virtual std::vector<double> closed_velocity(const Vector& solid_velocity,
                                              bool with_prescribed) const = 0;
};

}  // namespace lockstep
