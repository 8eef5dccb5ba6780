#pragma once
#include <functional>
#include <memory>

#include "coupling/coupled_system.hpp"
#include "coupling/viscous_solve.hpp"
#include "output/timers.hpp"
#include "stepping/components.hpp"
#include "stepping/solve_audit.hpp"
#include "stepping/step_report.hpp"

namespace lockstep {

struct StepperOptions {
  double tolerance = 1e-8;           ///< of the S1, F2 and S2 solves, per block
  double viscous_tolerance = 1e-10;  ///< relative, of the viscous CG
  int newton_iterations = 1;         ///< coupled solves each of S1 and S2 takes
  bool incremental_pressure = true;  ///< the viscous solve reads the last step's pressure
  bool rotational_pressure = true;   ///< and corrects it by the divergence that it leaves
};

/// The step F1 S1 F2 F3 S2 F4 of Section 7.
template <int dim>
class Stepper {
 public:
  /// Freezes the geometry of the start. Collective.
  Stepper(Components<dim>& components, const StepperOptions& options, double start_time,
          PhaseTimers& timers);

  /// Advances by dt. Throws SolveError if a solve fails, or if what is prescribed has no solution.
  /// Throws Interrupted (base/interruption.hpp) if a signal is received before the step is solved:
  /// then fluid and solids can be saved as they were at its start, and not stepped on. Collective.
  StepReport<dim> advance(double dt);
  double time() const { return time_; }
  /// For restart, after fluid and solids were loaded: freezes the geometry anew. `last_dt` is that
  /// of the last step taken. Collective.
  void resume(double time, double last_dt);
  CoupledSystem<dim>& system() { return system_; }

 private:
  void freeze();
  /// All of a step but its end: nothing yet that cannot be undone.
  CoupledSolution solve_step(double dt, StepReport<dim>& report);
  bool coupled() const { return components_.solids->has_unknowns(); }
  void predict_forces(double time, double dt, MomentumLedger<dim>* ledger, StepReport<dim>& report);
  void predict_viscosity(double time, double dt, StepReport<dim>& report);
  RCP<const Vector> expected_pressure(double time, double dt, StepReport<dim>& report);
  RCP<Vector> last_pressure(double dt) const;
  RCP<Vector> viscous_pressure(double viscosity, double dt);
  void reset_unseen_faces();
  RCP<const Vector> unseen_buoyancy(double dt, StepReport<dim>& report) const;
  double resolved_part(double dt);
  RCP<Vector> solid_momentum(double time, double dt, MomentumLedger<dim>* ledger,
                             StepReport<dim>& report);
  CoupledSolution solve(double dt, const RCP<Vector>& momentum, const char* name,
                        SolveReport& report, double& incompatibility);
  CoupledSolution solve_newton(double dt, const RCP<Vector>& momentum, const char* name,
                               SolveReport& report, double& incompatibility);
  void move_solids(double dt, StepReport<dim>& report);
  void make_advection_velocity(StepReport<dim>& report);
  void check_possible(double dt, double incompatibility) const;
  void finish(const CoupledSolution& solution, double dt, StepReport<dim>& report);
  ContactReport<dim> contact_momentum(double dt, Vector& momentum);
  ContactReport<dim> settled_momentum(double dt, Vector& momentum);
  CoupledSolution solve_settled(double dt, const RCP<Vector>& momentum, StepReport<dim>& report);
  RCP<Vector> at_locked_velocity(const Vector& velocity) const;
  SolveRequest request(const char* name, double dt) const;
  Momentum<dim> fluid_momentum() const;
  Momentum<dim> total_momentum() const;

  Components<dim>& components_;
  ComponentSides<dim> sides_;
  StepperOptions options_;
  PhaseTimers& timers_;
  CoupledSystem<dim> system_;
  double time_;
  double last_dt_ = 0;                 ///< 0 before the first step
  Momentum<dim> last_momentum_;        ///< at the end of the last step
  ViscousResult<dim> viscous_;         ///< of the present prediction; empty without viscosity
  RCP<Vector> viscous_pressure_;       ///< what S2 leaves out for the next step; null: nothing
  RCP<const Vector> locked_velocity_;  ///< of locked dofs in the present solve; null: at rest
};

}  // namespace lockstep
