#pragma once
#include <functional>
#include <memory>

#include "coupling/coupled_system.hpp"
#include "coupling/momentum_ledger.hpp"
#include "coupling/viscous_solve.hpp"
#include "interfaces/contact.hpp"
#include "interfaces/strategy.hpp"
#include "output/timers.hpp"

namespace lockstep {

/// The plug-ins of a scene.
template <int dim>
struct Components {
  std::unique_ptr<FluidDiscretization<dim>> fluid;
  std::unique_ptr<SolidSystem<dim>> solids;
  std::unique_ptr<Coupling<dim>> coupling;
  std::unique_ptr<SolverStrategy> strategy;
  std::unique_ptr<ContactModel<dim>> contact;  ///< null: solids do not touch
};

struct StepperOptions {
  double tolerance = 1e-8;           ///< of the S1, F2 and S2 solves, per block
  double viscous_tolerance = 1e-10;  ///< relative, of the viscous CG
  int newton_iterations = 1;         ///< coupled solves each of S1 and S2 takes
  double length = 1;                 ///< size of the domain [m], scales the angular audit
  bool audit_angular = true;  ///< false with periodic sides, where torque has no common origin
};

/// What happened in one step.
template <int dim>
struct StepReport {
  double time = 0, dt = 0;  ///< time at the end [s]
  double cfl = 0;           ///< of u^n over dt
  SolveReport s1, f2, s2;
  int viscous_iterations = 0;
  double max_divergence = 0;  ///< after F4, per cell [1/s]
  double incompatibility_s1 = 0, incompatibility_f2 = 0,
         incompatibility_s2 = 0;  ///< removed, relative
  MomentumLedger<dim> ledger;
  double momentum_error = 0, angular_momentum_error = 0;
  Momentum<dim> fluid_momentum, solid_momentum, boundary_impulse;
  /// What advection, revalidation, occlusion resets and the change of lumped masses did to the
  /// momentum.
  Momentum<dim> transport_change;
  /// Numerical torques over dt, see Coupling::lever_impulse and SolidSystem::implicit_impulse.
  AngularVector<dim> lever_impulse = AngularVector<dim>::Zero();
  AngularVector<dim> linearisation_impulse = AngularVector<dim>::Zero();
  double fluid_kinetic_energy = 0, solid_kinetic_energy = 0, elastic_energy = 0;  ///< [J]
  double fluid_volume = 0;
  std::vector<Momentum<dim>> hydrodynamic_impulse;  ///< per solid over dt, angular about the origin
  ContactReport<dim> contact_position, contact_velocity;
};

/// The step F1 S1 F2 F3 S2 F4 of Section 7.
template <int dim>
class Stepper {
 public:
  /// Freezes the geometry of the start. Collective.
  Stepper(Components<dim>& components, const StepperOptions& options, double start_time,
          PhaseTimers& timers);

  /// Advances by dt. Throws SolveError if a solve fails. Collective.
  StepReport<dim> advance(double dt);
  double time() const { return time_; }
  /// For restart, after fluid and solids were loaded: freezes the geometry anew. `last_dt` is that
  /// of the last step taken. Collective.
  void resume(double time, double last_dt);
  CoupledSystem<dim>& system() { return system_; }

 private:
  void freeze();
  struct CoupledSolution {
    BlockVector unknowns;
    BlockVector rhs;
    std::vector<double> coupled_before;  ///< u*_F
    RCP<Vector> momentum;                ///< M_S V_S* as it entered row 2
  };
  bool coupled() const { return components_.solids->has_unknowns(); }
  void predict_forces(double time, double dt, MomentumLedger<dim>* ledger, StepReport<dim>& report);
  void reset_unseen_faces();
  RCP<Vector> solid_momentum(double time, double dt, MomentumLedger<dim>* ledger,
                             StepReport<dim>& report);
  CoupledSolution solve(double dt, const RCP<Vector>& momentum, const char* name,
                        SolveReport& report, double& incompatibility);
  CoupledSolution solve_newton(double dt, const RCP<Vector>& momentum, const char* name,
                               SolveReport& report, double& incompatibility);
  void move_solids(double dt, StepReport<dim>& report);
  void make_advection_velocity(StepReport<dim>& report);
  void finish(const CoupledSolution& solution, double dt, StepReport<dim>& report);
  ContactReport<dim> contact_momentum(double dt, Vector& momentum);
  RCP<Vector> at_locked_velocity(const Vector& velocity) const;
  void ledger_solve(const CoupledSolution& solution, double dt, StepReport<dim>& report);
  SolveRequest request(const char* name, double dt) const;
  Momentum<dim> total_momentum() const;
  double largest_divergence(const BlockSystem& blocks, const BlockVector& rhs,
                            const BlockVector& solution) const;

  Components<dim>& components_;
  StepperOptions options_;
  PhaseTimers& timers_;
  CoupledSystem<dim> system_;
  double time_;
  double last_dt_ = 0;                 ///< 0 before the first step
  Momentum<dim> last_momentum_;        ///< at the end of the last step
  RCP<Vector> viscous_impulse_;        ///< j_nu of the present prediction, or null
  RCP<const Vector> locked_velocity_;  ///< of locked dofs in the present solve; null: at rest
};

}  // namespace lockstep
