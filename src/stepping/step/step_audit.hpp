#pragma once
#include "stepping/report/step_report.hpp"
#include "stepping/step/advection_velocity.hpp"
#include "stepping/step/position_update.hpp"
#include "stepping/step/prediction.hpp"
#include "stepping/step/step_energy.hpp"

namespace lockstep {

/// Results of the stages of a step; empty where a scene or a scheme does without one.
template <int dim>
struct StageResults {
  Friction<dim> start;  ///< before positions are found
  SolidPath<dim> path;
  AdvectionReport advection;
  FluidForces<dim> forces;  ///< before velocities are found, and so on
  Friction<dim> friction;
  SolidMomentum<dim> solids;
  MotionWithContacts<dim> end;
};

/// Makes the report of a step: the momentum ledger, the energy budget, the divergence that is left.
/// Told where the step is, it looks at fluid and solids, and changes nothing. All collective.
template <int dim>
class StepAudit {
 public:
  /// `with_energy`: it keeps the energy budget. `with_surface_forces`: it reports where the fluid
  /// pushes; throws InputError if the coupling does not tell.
  StepAudit(Components<dim>& components, CoupledSystem<dim>& system, bool with_energy,
            bool with_surface_forces);

  /// Momentum that changes from the last step on is transport: the geometry is frozen at the start
  /// of the run, or other dofs are unknowns, at `time`; u* = u^n.
  void start(double time) { last_momentum_ = total_momentum(time, fluid_momentum()); }
  /// Fluid and solids are at the begin of the step.
  void begin(const StepTime& step);
  /// u* and the geometry are those on which the forces that change velocities act.
  void end_transport(const StepTime& step);
  void end_forces();     ///< explicit forces have changed u*
  void end_viscosity();  ///< viscosity has changed u*
  /// The pressure that is found does not act on u* yet: books what the stages gave.
  StepReport<dim> report(const StepContext<dim>& context, const StageResults<dim>& stages) const;
  /// u* is that of the end, solids do not know their velocities yet.
  void end_projection(const StepContext<dim>& context, const StageResults<dim>& stages,
                      const StepReport<dim>& report);
  /// Fluid, solids and joints are at the end of the step: closes the books.
  void close(const StepContext<dim>& context, const CoupledSolution& solution,
             StepReport<dim>& report);

 private:
  Momentum<dim> fluid_momentum() const;
  Momentum<dim> total_momentum(double time, const Momentum<dim>& of_fluid) const;
  double largest_divergence(const BlockSystem& blocks, const CoupledSolution& solution) const;
  void book_forces(const StageResults<dim>& stages, StepReport<dim>& report) const;
  void book_pressure(const StageResults<dim>& stages, StepReport<dim>& report) const;
  void book_solids(const StepContext<dim>& context, const StageResults<dim>& stages,
                   StepReport<dim>& report) const;
  std::vector<Momentum<dim>> contact_impulses(const MotionWithContacts<dim>& motion) const;
  SurfaceForces<dim> surface_forces(const StageResults<dim>& stages) const;
  void find_errors(StepReport<dim>& report) const;

  Components<dim>& components_;
  ComponentSides<dim> sides_;
  CoupledSystem<dim>& system_;
  bool with_surface_forces_;
  double cfl_ = 0;                         ///< CFL number of the present step [1]
  Momentum<dim> before_;                   ///< before forces act in the present step
  Momentum<dim> last_momentum_;            ///< at the end of the last step
  std::optional<StepEnergy<dim>> energy_;  ///< none: nobody wants it
};

}  // namespace lockstep
