#pragma once
#include <optional>

#include "coupling/viscous_solve.hpp"
#include "stepping/step/coupled_solve.hpp"

namespace lockstep {

struct PredictionOptions {
  ViscousOptions viscous;
  bool incremental_pressure = true;  ///< the viscous solve reads the last step's pressure
  bool rotational_pressure = true;   ///< the divergence that it leaves corrects this pressure
  bool surface_forces = false;       ///< reports have `StepReport::surface_forces`
};

/// The impulses of explicit forces on the fluid. Zero where positions are moved.
template <int dim>
struct FluidForces {
  Momentum<dim> body;
  std::optional<Momentum<dim>> tension;  ///< explicit part of surface tension
};

/// Effects of viscosity beside the change of u*.
template <int dim>
struct Friction {
  ViscousResult<dim> viscous;  ///< empty without viscosity
  RCP<Vector> pressure;        ///< -mu div u' over dt, part of the next step's p̂; null: none
  SolveReport pressure_work;   ///< solve for a pressure that only viscosity needs
  double viscous_number = 0;   ///< nu dt / h^2
  Momentum<dim> tension;       ///< implicit part of surface tension; as in FluidForces
};

/// Makes u* of a velocity: explicit forces, then viscosity with the solids (Eqs. 20 and 21).
template <int dim>
class Prediction {
 public:
  /// Throws InputError if the fluid is viscous and the coupling is not.
  Prediction(Components<dim>& components, CoupledSystem<dim>& system, CoupledSolve<dim>& solve,
             const PredictionOptions& options, StageTimers& timers);

  /// u* += dt times explicit forces. Collective.
  FluidForces<dim> add_forces(const StepContext<dim>& context);
  /// Implicit viscosity in the incremental form of pressure correction (Guermond, Minev and Shen
  /// 2006): fluid and solids feel the expected pressure while they feel viscosity, and give it back
  /// before the coupled solve finds the pressure, whole. Their velocities then are nearly those at
  /// the end of the step, so that forces that the pressure holds (weight, mean gradients) do not
  /// shear the fluid at walls and solids; a steady state does not depend on dt. Follows
  /// `add_forces`, whose result it gets. Collective.
  Friction<dim> add_viscosity(const StepContext<dim>& context, const FluidForces<dim>& forces);

 private:
  /// The pressure that the viscous solve expects of the coupled solve after it.
  struct Expected {
    RCP<const Vector> of_fluid;  ///< p̂; null: none is
    std::vector<double> of_gas;  ///< p̂ of bubbles
    SolveReport work;            ///< solve that finds it
  };
  Expected expected_pressure(const StepContext<dim>& context);
  Friction<dim> solve(const StepContext<dim>& context, const Expected& expected);
  RCP<Vector> solid_row(const StepContext<dim>& context, const Expected& expected);
  RCP<Vector> viscous_pressure(double viscosity, double dt, const RCP<const Vector>& velocity);

  Components<dim>& components_;
  ComponentSides<dim> sides_;
  CoupledSystem<dim>& system_;
  CoupledSolve<dim>& solve_;
  SolidForces<dim> solid_forces_;
  TrappedGas<dim> gas_;
  PredictionOptions options_;
  StageTimers& timers_;
};

}  // namespace lockstep
