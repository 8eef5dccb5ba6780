#pragma once
#include <vector>

#include "coupling/coupled_system.hpp"
#include "interfaces/energy.hpp"
#include "stepping/step/components.hpp"
#include "stepping/step/coupled_solution.hpp"
#include "stepping/step/step_context.hpp"

namespace lockstep {

/// Keeps the energy budget of a step: told where the step is, it looks at fluid and solids. All
/// collective. Of a fluid without an EnergyFluid only solids are in the book.
template <int dim>
class StepEnergy {
 public:
  StepEnergy(Components<dim>& components, const CoupledSystem<dim>& system);

  /// Begins the budget of the step: fluid and solids are at its begin.
  void begin();
  /// u* and the geometry are those on which the forces of F3 act.
  void end_transport();
  void end_forces();    ///< forces of F3, but for viscosity
  void end_friction();  ///< viscosity
  /// u* is that of the end, solids do not know their velocities yet. `reactions`: of constraints;
  /// null: of none. `friction`: of the fluid on the solids; null: none.
  void end_solve(const StepContext<dim>& context, const CoupledSolution& solution,
                 const RCP<const Vector>& friction, const RCP<const Vector>& reactions);
  /// Solids and joints are at the end of the step, at `time`, whose length is dt.
  EnergyBudget end(double time, double dt);

 private:
  double fluid_energy() const;
  double solid_energy(bool elastic) const;
  void add_solids(const StepContext<dim>& context, const CoupledSolution& solution,
                  const RCP<const Vector>& friction, const RCP<const Vector>& reactions);
  void add_lumping(const CoupledSolution& solution);

  Components<dim>& components_;
  const CoupledSystem<dim>& system_;
  EnergyFluid<dim>* fluid_;             ///< null: it cannot tell
  const AuditedFluid<dim>* audited_;    ///< likewise
  EnergyBudget book_;                   ///< budget of this step, as far as it is known [J]
  RCP<const Vector> velocity_;          ///< V^n
  std::vector<double> coupled_before_;  ///< u*_F before forces
  double fluid_energy_ = 0, elastic_energy_ = 0, kinetic_energy_ = 0;  ///< at the begin
};

}  // namespace lockstep
