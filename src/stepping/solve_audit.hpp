#pragma once
#include <vector>

#include "coupling/coupled_system.hpp"
#include "coupling/viscous_solve.hpp"
#include "stepping/components.hpp"
#include "stepping/report/step_report.hpp"
#include "stepping/step_context.hpp"

namespace lockstep {

/// A solve of Eq. 16 and what went into it.
struct CoupledSolution {
  BlockVector unknowns;  ///< p̂ and y
  RCP<Vector> velocity;  ///< V of all dofs, of solids without unknowns zero
  BlockVector rhs;
  std::vector<double> coupled_before;  ///< u*_F
  RCP<Vector> momentum;                ///< M_S V_S* as it entered row 2
  RCP<Vector> gas_momentum;            ///< what pockets of gas gave besides; null: there are none
  std::vector<double> gas_pressure;    ///< p̂ of the pockets; empty: there are none
};

/// Largest residual of row 1 per cell [1/s]. Collective.
double largest_divergence(const BlockSystem& blocks, const CoupledSolution& solution,
                          double spacing, int dim);

/// Enters the impulses of the S2 solve into the ledger, each from its own pressure, and reports
/// what the fluid gave to every solid, on top of the buoyancy that is there. `viscous`: empty for a
/// fluid without viscosity. Collective.
template <int dim>
void audit_solve(const Components<dim>& components, const ComponentSides<dim>& sides,
                 CoupledSystem<dim>& system, const StepContext<dim>& context,
                 const CoupledSolution& solution, const ViscousResult<dim>& viscous,
                 StepReport<dim>& report);

/// The errors of momentum that the closed ledger shows; nan if not all plug-ins tell theirs.
/// Torques of periodic fluids have no common origin. Collective.
template <int dim>
void audit_momentum(const Components<dim>& components, const ComponentSides<dim>& sides,
                    StepReport<dim>& report);

}  // namespace lockstep
