#pragma once
#include <functional>
#include <memory>
#include <optional>

#include "coupling/coupled_system.hpp"
#include "coupling/viscous_solve.hpp"
#include "output/timers.hpp"
#include "stepping/components.hpp"
#include "stepping/implicit_motion.hpp"
#include "stepping/report/step_report.hpp"
#include "stepping/solve_audit.hpp"
#include "stepping/step_context.hpp"
#include "stepping/step_energy.hpp"

namespace lockstep {

struct StepperOptions {
  double tolerance = 1e-8;  ///< of the S1, F2 and S2 solves, per block
  ViscousOptions viscous;
  int newton_iterations = 1;         ///< coupled solves each of S1 and S2 takes
  bool incremental_pressure = true;  ///< the viscous solve reads the last step's pressure
  bool rotational_pressure = true;   ///< and corrects it by the divergence that it leaves
  bool energy_book = false;          ///< steps keep it
};

/// What F1 or the forces of F3 find beside the velocity of the fluid.
template <int dim>
struct Prediction {
  ViscousResult<dim> viscous;  ///< empty without viscosity
  RCP<Vector> pressure;        ///< what S2 leaves out for the next step; null: nothing
  SolveReport pressure_work;   ///< of a pressure that was solved for just for it
};

/// What is expected of the pressure of a solve, before it.
struct ExpectedPressure {
  RCP<const Vector> of_fluid;  ///< p̂
  std::vector<double> of_gas;  ///< p̂ of pockets
  SolveReport work;            ///< what finding it took
};

/// The step F1 S1 F2 F3 S2 F4 of Section 7.
template <int dim>
class Stepper {
 public:
  /// Freezes the geometry of the start. Collective.
  Stepper(Components<dim>& components, const StepperOptions& options, double start_time,
          StageTimers& timers);

  /// Advances by dt. Throws SolveError if a solve fails, or if what is prescribed has no solution.
  /// `between_stages` is called between the stages; once it has thrown, fluid and solids are
  /// somewhere within the step, and of no use. Collective.
  StepReport<dim> advance(
      double dt, const std::function<void()>& between_stages = [] {});
  double time() const { return time_; }
  /// For restart, after fluid and solids were loaded: freezes the geometry anew. `last_dt` is that
  /// of the checkpoint's last step. Collective.
  void resume(const CheckpointReader& checkpoint, double last_dt);
  CoupledSystem<dim>& system() { return system_; }

 private:
  /// S2 with all that its end needs.
  struct Solved {
    StepContext<dim> context;
    Prediction<dim> prediction;
    CoupledSolution solution;
  };
  /// V^{n+1/2}.
  struct FoundMotion {
    RCP<Vector> velocity;
    RCP<const Vector> solved;   ///< before contact; null without joints
    RCP<Vector> joint_impulse;  ///< of the joints; null without
  };
  void freeze();
  void freeze(const std::shared_ptr<const SurfaceSnapshot<dim>>& surface);
  bool solids_rest() const;
  void make_room(double dt);
  /// All of a step but its end.
  Solved solve_step(double dt, const std::function<void()>& between_stages,
                    StepReport<dim>& report);
  bool coupled() const { return components_.solids->has_unknowns(); }
  StepContext<dim> context_of_positions(double dt) const;
  StepContext<dim> context_of_velocities(double dt, MomentumLedger<dim>& ledger,
                                         const StartImpulse& joints) const;

  // F1, and the forces of F3.
  Prediction<dim> predict_forces(const StepContext<dim>& context, StepReport<dim>& report);
  Prediction<dim> predict_viscosity(const StepContext<dim>& context, StepReport<dim>& report);
  ExpectedPressure expected_pressure(const StepContext<dim>& context, StepReport<dim>& report);
  RCP<Vector> last_pressure(double dt) const;
  RCP<Vector> viscous_pressure(double viscosity, double dt, const RCP<const Vector>& velocity);
  void reset_unseen_faces();

  // S1 and S2.
  RCP<const Vector> unseen_buoyancy(double dt, StepReport<dim>& report) const;
  void add_drops(const StepContext<dim>& context, Vector& momentum, StepReport<dim>& report) const;
  RCP<Vector> explicit_momentum(const StepContext<dim>& context) const;
  RCP<Vector> midpoint_correction(double dt) const;
  RCP<Vector> solid_momentum(const StepContext<dim>& context, const Prediction<dim>& prediction,
                             StepReport<dim>& report, const RCP<const Vector>& correction = {});
  CoupledSolution solve(const StepContext<dim>& context, const RCP<Vector>& momentum,
                        const std::string& name, SolveReport& report, double& incompatibility,
                        const BlockVector* nearby = nullptr);
  CoupledSolution solve_newton(const StepContext<dim>& context, const RCP<Vector>& momentum,
                               SolveReport& report, double& incompatibility,
                               const BlockVector* nearby = nullptr);
  CoupledSolution solve_settled(const StepContext<dim>& context, const RCP<Vector>& momentum,
                                StepReport<dim>& report);
  ContactResponse contact_response(double dt) const;
  ContactReport<dim> contact_momentum(const StepContext<dim>& context, Vector& momentum);
  ContactReport<dim> settled_momentum(const StepContext<dim>& context, Vector& momentum);
  FoundMotion find_motion(const StepContext<dim>& context, const Prediction<dim>& prediction,
                          const RCP<const Vector>& correction, BlockVector& solution,
                          StepReport<dim>& report);
  StartImpulse close_joints(StepContext<dim> context, const Prediction<dim>& prediction,
                            const RCP<const Vector>& correction, BlockVector& solution,
                            FoundMotion& found, StepReport<dim>& report);
  StartImpulse move_solids(const StepContext<dim>& context, const Prediction<dim>& prediction,
                           StepReport<dim>& report);
  // Pockets of gas.
  bool has_gas() const;
  std::vector<double> expected_gas_pressure(double dt) const;
  void project(const Vector& scaled_pressure, const std::vector<double>& gas_pressure);
  void solve_coupled(const StepContext<dim>& context, const BlockSystem& blocks,
                     const SolveRequest& request, CoupledSolution& solution, SolveReport& report);
  std::vector<double> solve_advection(double dt, const std::vector<double>& effective,
                                      const BlockSystem& blocks, BlockVector& rhs,
                                      BlockVector& solution, SolveReport& report);
  SolveRequest request(const std::string& name, double dt) const;
  void check_possible(const StepContext<dim>& context, double incompatibility) const;

  void make_advection_velocity(double dt, StepReport<dim>& report);  // F2
  void advect(double dt, StepReport<dim>& report);                   // F3
  void finish(const Solved& solved, StepReport<dim>& report);        // F4
  void tell_joints(const StepContext<dim>& context, const StepReport<dim>& report);
  Momentum<dim> fluid_momentum() const;
  Momentum<dim> total_momentum(const Momentum<dim>& of_fluid) const;

  Components<dim>& components_;
  ComponentSides<dim> sides_;
  StepperOptions options_;
  StageTimers& timers_;
  CoupledSystem<dim> system_;
  double time_;
  double last_dt_ = 0;           ///< 0 before the first step
  long long n_steps_ = 0;        ///< taken
  bool fluid_moved_ = false;     ///< to other cells, before this step
  bool frozen_at_rest_ = false;  ///< the geometry is that of solids that did not move then
  Momentum<dim> last_momentum_;  ///< at the end of the last step
  std::optional<StepEnergy<dim>> energy_;  ///< none: nobody wants it
};

}  // namespace lockstep
