// One step of the paper (Robinson-Mosher et al. 2008, Section 7), from t^n to t^{n+1} = t^n + dt.
// The geometry (cells, faces, A, B, W) is that of x^n in 1 to 4, of x^{n+1} from then on.
//
//   1  F1  u* = u^n + dt/2 (g + nu lap u* - grad p^n / rho) + dt/2 grad p^n / rho
//   2  S1  A p - B V = -G^T u*,  B^T p + C V = M_S V* + W^T M_F u*_F    over dt/2; p is dropped
//          C = M_S + W^T M_F W - dt/2 D;  V changes so that strains keep their limits, closed
//          regions their volumes, contacts g + dt J_n V >= 0, joints their bodies
//   3      x^{n+1} = x^n + dt V
//   4  F2  u_ADV = u^n - M^-1 G p,  G^T u_ADV = 0,  solids at (x^{n+1} - x^n) / dt
//   5  F3  u* = u^n carried along u_ADV, scalars and the free surface with it; forces and viscosity
//          as 1, over dt
//   6  S2  as 2, over dt, with C of x^{n+1}; contacts act on V*: J_n V* >= 0 for what touches
//   7  F4  u^{n+1} = u* - M^-1 G p,  u^{n+1}_F = W V;  V^{n+1} = V
#include "stepping/step/paper_step.hpp"

namespace lockstep {

/// 1 to 3: held dofs have their mean velocities, so that positions follow their scripts.
template <int dim>
StepContext<dim> PaperStep<dim>::positions(const StepTime& step) const {
  return {step,        "S1", step.begin,
          step.dt / 2, true, components_.solids->constraints(step.begin, step.end())};
}

/// 5 to 7: held dofs have their velocities at the end of the step.
template <int dim>
StepContext<dim> PaperStep<dim>::velocities(const StepTime& step,
                                            const StartImpulse& joints) const {
  return {step,    "S2",  step.begin,
          step.dt, false, components_.solids->constraints(step.end(), step.end()),
          joints};
}

template <int dim>
StepReport<dim> PaperStep<dim>::advance(double dt, const std::function<void()>& between_stages) {
  const auto run = [&](const std::string& name, const auto& stage) {
    between_stages();
    const ScopedStage timed(timers_, name);
    return stage();
  };
  const StepTime step{time_, dt, last_dt_, n_steps_ + 1};
  StageResults<dim> stages;
  const bool is_projected = !this->begin(step) && last_dt_ > 0;

  const StepContext<dim> half = positions(step);
  if (components_.solids->has_unknowns())  // F1 serves S1 only
    stages.start = run("F1", [&] {
      transport_.begin_prediction();
      return prediction_.add_viscosity(half, prediction_.add_forces(half));
    });
  between_stages();
  stages.path = positions_.find(half, stages.start.viscous.solid_impulse);  // S1
  run("solid motion", [&] { components_.solids->move(*stages.path.velocity, step.begin, dt); });
  stages.advection = run("F2", [&] { return advection_.make(step, "F2", is_projected); });
  run("F3 advection", [&] {
    transport_.carry(step);
    audit_.end_transport(step);
  });
  const StepContext<dim> whole = velocities(step, stages.path.joints);
  run("F3 forces", [&] {
    stages.forces = prediction_.add_forces(whole);
    audit_.end_forces();
    stages.friction = prediction_.add_viscosity(whole, stages.forces);
    audit_.end_viscosity();
  });
  stages.end = run("S2", [&] {
    stages.solids = solid_forces_.momentum(whole);
    return solve_.velocities(whole, stages.solids, stages.friction.viscous.solid_impulse);
  });
  return run("end", [&] {  // F4
    StepReport<dim> report = this->finish(whole, stages);
    this->end(step);
    return report;
  });
}

template class PaperStep<2>;
template class PaperStep<3>;

}  // namespace lockstep
