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
  /// present cells. `negligible`: 2-norm of a divergence that may stay [m^dim/s]. Throws
  /// SolveError. Collective.
  AdvectionReport make(const StepTime& step, const std::string& name, bool is_projected,
                       double negligible = 0);
  double tolerance() const { return tolerance_; }

 private:
  Components<dim>& components_;
  CoupledSystem<dim>& system_;
  TrappedGas<dim> gas_;
  double tolerance_;
};

}  // namespace lockstep
