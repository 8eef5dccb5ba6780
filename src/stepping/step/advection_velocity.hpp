#pragma once
#include "coupling/coupled_system.hpp"
#include "output/timers.hpp"
#include "stepping/step/trapped_gas.hpp"

namespace lockstep {

/// Report on making the advection velocity.
struct AdvectionReport {
  SolveReport solve;           ///< empty where u^n is it
  double incompatibility = 0;  ///< see CoupledSolution
};

/// Makes the advection velocity u_ADV: u^n without divergence, with the effective velocity of the
/// solids, (x^{n+1} - x^n) / dt, as Neumann data, so that no fluid passes a solid.
template <int dim>
class AdvectionVelocity {
 public:
  AdvectionVelocity(Components<dim>& components, CoupledSystem<dim>& system, double tolerance)
      : components_(components), system_(system), gas_(components), tolerance_(tolerance) {}

  /// Leaves u_ADV in u*; the solids have moved. `is_projected`: u^n has no divergence on the
  /// present cells. Throws SolveError. Collective.
  AdvectionReport make(const StepTime& step, bool is_projected);
  /// As `make`, of the velocity that the first kick gave. `negligible`: 2-norm of a divergence that
  /// may stay [m^dim/s].
  AdvectionReport make_from_kick(const StepTime& step, double negligible);
  double tolerance() const { return tolerance_; }

 private:
  AdvectionReport project(const StepTime& step, double negligible);

  Components<dim>& components_;
  CoupledSystem<dim>& system_;
  TrappedGas<dim> gas_;
  double tolerance_;
};

}  // namespace lockstep
