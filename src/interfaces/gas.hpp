#pragma once
#include <vector>

#include "interfaces/coupling.hpp"

namespace lockstep {

/// A closed gas bubble beside a liquid. It has no mass and one pressure, which pushes on all that
/// is around it. Global.
struct GasBubble {
  double volume = 0;     ///< [m^dim]
  double pressure = 0;   ///< above the pressure of the air: a function of the volume, or the last
                         ///< step's if the bubble keeps its volume [Pa]
  double stiffness = 0;  ///< -dp/dV [Pa/m^dim]; unused if it keeps its volume
  bool keeps_volume = false;
  double missing = 0;  ///< volume defect, to be made good within the step [m^dim]
};

/// Side interface of fluids with gas bubbles: the bubbles of the frozen geometry, the same on all
/// ranks. Vectors have one entry per bubble, indexed by `PressureSide::bubble`.
template <int dim>
class GasFluid {
 public:
  virtual ~GasFluid() = default;
  virtual const std::vector<GasBubble>& gas_bubbles() const = 0;
  /// rhs += volume rate that scaled bubble pressures p̂ = dt p [Pa s] push out of the pressure
  /// unknowns beside them [m^dim/s]. Local.
  virtual void add_gas_push(const std::vector<double>& scaled_pressure, Vector& rhs) const = 0;
  /// Returns per bubble the volume rate by which a unit of its p̂ opens it if no pressure unknown
  /// answers, [m^dim/s / (Pa s)]: the sum of `add_gas_push` of that unit. Collective.
  virtual std::vector<double> gas_conductance() const = 0;
  /// Returns the rate at which u* on the free faces opens each bubble [m^dim/s]; `gas_answer` the
  /// rate by which these p̂ of the unknowns reduce it. Collective.
  virtual std::vector<double> gas_rates() const = 0;
  virtual std::vector<double> gas_answer(const Vector& scaled_pressure) const = 0;
  /// Projects as `FluidDiscretization::project` does, but with these pressures in the bubbles
  /// instead of none. Collective.
  virtual void project(const Vector& scaled_pressure, const std::vector<double>& gas_pressure) = 0;
  /// Impulse of the sides of the domain on the bubbles beside them [kg m/s]. Collective.
  virtual Momentum<dim> gas_side_impulse(const std::vector<double>& scaled_pressure) const = 0;
};

/// Side interface of couplings: gas pushes on the solids around it. `AuditedCoupling` counts that
/// impulse.
template <int dim>
class GasCoupling {
 public:
  virtual ~GasCoupling() = default;
  /// momentum += impulse of the bubbles' p̂ on dynamic solids [kg m/s]. Collective.
  virtual void add_gas_push(const std::vector<double>& scaled_pressure, Vector& momentum) const = 0;
  /// Returns per bubble the sum of the magnitudes of the impulses of a unit of its p̂ on all dofs,
  /// before any cancel: the scale of the round-off of `add_gas_push`. Collective.
  virtual std::vector<double> gas_push_size(int n_bubbles) const = 0;
  /// Returns the rate at which the closed parts of coupled volumes open each bubble [m^dim/s]: at
  /// these velocities of the solids, with the part of prescribed ones if asked for. Collective.
  virtual std::vector<double> gas_rates(const Vector& solid_velocity, bool with_prescribed,
                                        int n_bubbles) const = 0;
  /// Returns that rate at the effective velocities of all solids over the last `move`. Collective.
  virtual std::vector<double> effective_gas_rates(const SolidSystem<dim>& solids,
                                                  int n_bubbles) const = 0;
};

}  // namespace lockstep
