#pragma once
#include "interfaces/fluid_sides.hpp"
#include "interfaces/strategy.hpp"
#include "stepping/step/components.hpp"
#include "stepping/step/step_context.hpp"

namespace lockstep {

/// A solve of Eq. 16, and what went into it.
struct CoupledSolution {
  BlockVector unknowns;  ///< p̂ and y
  RCP<Vector> velocity;  ///< V of all dofs, of solids without unknowns zero
  BlockVector rhs;
  std::vector<double> coupled_before;  ///< u*_F
  RCP<Vector> momentum;                ///< M_S V_S* as it entered row 2
  RCP<Vector> gas_momentum;            ///< impulse of gas bubbles besides; null: there are none
  std::vector<double> gas_pressure;    ///< p̂ of the bubbles; empty: there are none
  SolveReport report;                  ///< report of all the solves that led here
  double incompatibility = 0;          ///< part of the right-hand side that was removed [1]
  bool is_converged = true;  ///< implicit forces of solids are those at the velocity that was found
};

/// p̂ = dt p with the last step's pressure p; zero before the first step. Collective.
template <int dim>
RCP<Vector> last_pressure(const FluidDiscretization<dim>& fluid, const StepTime& step, double dt);

/// Impulse on solids over dt of the hydrostatic force of fluid at rest
/// (`HydrostaticCoupling::add_impulse_at_rest`); zero without such a force. Collective.
template <int dim>
RCP<Vector> impulse_at_rest(const Components<dim>& components, double dt);

/// Accuracy that a solve over dt has to reach. Residuals below the round-off of the fluxes, with
/// the speed that gravity may add, are nothing: in each cell a few bits of what passes a face, in
/// the norm over all cells root of their number as much. Collective.
template <int dim>
SolveRequest solve_request(const FluidDiscretization<dim>& fluid, const std::string& name,
                           double tolerance, const StepTime& step, double dt);

}  // namespace lockstep
