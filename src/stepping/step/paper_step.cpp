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

namespace {

/// 1 to 3: held dofs have their mean velocities, so that positions follow their scripts.
template <int dim>
StepContext<dim> of_positions(const StepParts<dim>& parts, const StepTime& step) {
  return {step,        "S1", step.begin,
          step.dt / 2, true, parts.components.solids->constraints(step.begin, step.end())};
}

/// 5 to 7: held dofs have their velocities at the end of the step.
template <int dim>
StepContext<dim> of_velocities(const StepParts<dim>& parts, const StepTime& step,
                               const StartImpulse& joints) {
  return {step,    "S2",  step.begin,
          step.dt, false, parts.components.solids->constraints(step.end(), step.end()),
          joints};
}

}  // namespace

template <int dim>
StepReport<dim> paper_step(StepParts<dim>& parts, const StepTime& step, const StageRunner& run) {
  auto& solids = *parts.components.solids;
  StageResults<dim> stages;
  const bool is_projected = !parts.begin(step) && step.last_dt > 0;

  const StepContext<dim> half = of_positions(parts, step);
  if (solids.has_unknowns())  // F1 serves S1 only
    stages.start = run("F1", [&] {
      parts.transport.begin_prediction();
      return parts.prediction.add_viscosity(half, parts.prediction.add_forces(half));
    });
  run.pause();
  stages.path = parts.positions.find(half, stages.start.viscous.solid_impulse);  // S1
  run("solid motion", [&] { solids.move(*stages.path.velocity, step.begin, step.dt); });
  stages.advection = run("F2", [&] { return parts.advection.make(step, is_projected); });
  run("F3 advection", [&] {
    parts.transport.carry(step);
    parts.audit.end_transport(step);
  });
  const StepContext<dim> whole = of_velocities(parts, step, stages.path.joints);
  run("F3 forces", [&] {
    stages.forces = parts.prediction.add_forces(whole);
    parts.audit.end_forces();
    stages.friction = parts.prediction.add_viscosity(whole, stages.forces);
    parts.audit.end_viscosity();
  });
  stages.end = run("S2", [&] {
    stages.solids = parts.solid_forces.momentum(whole);
    return parts.solve.velocities(whole, stages.solids, stages.friction.viscous.solid_impulse);
  });
  return run("end", [&] { return parts.finish(whole, stages); });  // F4
}

template StepReport<2> paper_step(StepParts<2>&, const StepTime&, const StageRunner&);
template StepReport<3> paper_step(StepParts<3>&, const StepTime&, const StageRunner&);

}  // namespace lockstep
