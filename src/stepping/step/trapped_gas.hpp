#pragma once
#include "coupling/gas_solve.hpp"
#include "stepping/step/components.hpp"
#include "stepping/step/coupled_solution.hpp"

namespace lockstep {

/// The bubbles of gas beside a liquid in the solves of a step; without gas its solves are those of
/// the strategy. Vectors of pressures have one entry per bubble.
template <int dim>
class TrappedGas {
 public:
  /// Throws InputError if the fluid has gas that the coupling does not know.
  explicit TrappedGas(const Components<dim>& components);

  /// p̂ of the bubbles at the start of a solve over dt. Empty: there are none.
  std::vector<double> expected_pressure(double dt) const;
  /// Takes the gradients of p̂ of fluid and bubbles from u*. Collective.
  void project(const Vector& scaled_pressure, const std::vector<double>& gas_pressure) const;
  /// Solves Eq. 16 with the bubbles' pressures: from the right-hand side in `solution`, and from
  /// its unknowns on. Collective.
  void solve(const StepContext<dim>& context, const BlockSystem& blocks,
             const SolveRequest& request, CoupledSolution& solution) const;
  /// Solves for u_ADV, as `solve`, with solids at their effective velocities.
  /// Bubbles that keep their volume do so in u_ADV, too; others have the solids change it by no
  /// more than the next solve answers. Collective.
  void solve_advection(double dt, const BlockSystem& blocks, const SolveRequest& request,
                       CoupledSolution& solution) const;

 private:
  /// Throws InputError in the first step, SolveError later, if the solution changes a bubble that
  /// keeps its volume, because nothing around it gives way. Collective.
  void check_volumes(const StepContext<dim>& context, const GasProblem& gas,
                     const CoupledSolution& solution) const;
  bool is_there() const;
  GasProblem problem(double dt, double step_dt) const;

  const Components<dim>& components_;
  GasFluid<dim>* fluid_;              ///< null: it knows no gas
  const GasCoupling<dim>* coupling_;  ///< null: it knows no gas
};

}  // namespace lockstep
