#pragma once
#include "coupling/swept_volumes.hpp"
#include "interfaces/constraint.hpp"
#include "stepping/step/coupled_solve.hpp"

namespace lockstep {

/// Motion of the solids to their next positions.
template <int dim>
struct SolidPath {
  RCP<const Vector>
      velocity;         ///< V of all dofs: positions move by its product with the step's length
  StartImpulse joints;  ///< for the velocities at the end of the step
  ContactReport<dim> contact;
  SolveReport report;               ///< report of the coupled solves
  double incompatibility = 0;       ///< see CoupledSolution
  bool is_converged = true;         ///< see CoupledSolution
  double stretch_beyond_limit = 0;  ///< see SolidOutput
};

/// A path on which joints stay closed, and what that asks of the solve before it.
template <int dim>
struct ClosedDrift {
  SolidPath<dim> path;
  ClosedMotion motion;
};

/// Finds the velocity that moves the solids over a step: from a coupled solve, changed so that
/// elements keep their limits of strain, closed regions their volume, contacts their gaps and
/// joints their bodies.
template <int dim>
class PositionUpdate {
 public:
  PositionUpdate(Components<dim>& components, CoupledSystem<dim>& system, CoupledSolve<dim>& solve,
                 StageTimers& timers);

  /// `drag`: viscous impulse on the solids in the coupled solve; null: none. Moves nothing.
  /// Collective.
  SolidPath<dim> find(const StepContext<dim>& context, const RCP<const Vector>& drag);
  /// The path of rigid solids that go on with the velocity they have: they turn as their angular
  /// momenta have it, and what overlaps is pushed out. Moves nothing. Collective.
  SolidPath<dim> drift(const StepContext<dim>& context);
  /// As `drift`, of solids with joints that a solve gave `velocity`, with `correction` among its
  /// impulses; what overlaps is pushed out, then the joints are closed. Collective.
  ClosedDrift<dim> closed_drift(const StepContext<dim>& context, const Vector& velocity,
                                const Vector& correction);

 private:
  /// A path with what closing its joints asks of it.
  struct Found {
    SolidPath<dim> path;
    RCP<Vector> velocity;         ///< velocity of the path
    RCP<const Vector> solved;     ///< before contact; null without joints
    RCP<Vector> joint_impulse;    ///< impulse of joints in the solve; null without joints
    SweptRates swept;             ///< rates of the solve [m^dim/s]
    CoupledSolution solution;     ///< empty without unknowns
    bool holds_contacts = false;  ///< the solve does
  };
  Found find_once(const StepContext<dim>& context, const RCP<const Vector>& drag,
                  const RCP<const Vector>& correction, const BlockVector* nearby);
  void solve(const StepContext<dim>& context, const RCP<const Vector>& drag,
             const RCP<const Vector>& correction, const BlockVector* nearby, Found& found);
  void keep_limits(const StepContext<dim>& context, Found& found);
  SolidPath<dim> find_with_joints(StepContext<dim> context, const RCP<const Vector>& drag);

  Components<dim>& components_;
  CoupledSystem<dim>& system_;
  CoupledSolve<dim>& solve_;
  SolidForces<dim> solid_forces_;
  StageTimers& timers_;
};

}  // namespace lockstep
