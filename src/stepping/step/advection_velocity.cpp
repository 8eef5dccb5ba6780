#include "stepping/step/advection_velocity.hpp"

#include <Tpetra_Vector.hpp>
#include <algorithm>

#include "linear/null_space.hpp"

namespace lockstep {

template <int dim>
AdvectionReport AdvectionVelocity<dim>::make(const StepTime& step, bool is_projected) {
  const bool has_no_divergence = components_.fluid->begin_advection_velocity(step.dt);
  if (components_.solids->empty() && is_projected && has_no_divergence)
    return {};
  return project(step, 0);
}

template <int dim>
AdvectionReport AdvectionVelocity<dim>::make_from_kick(const StepTime& step, double negligible) {
  components_.fluid->begin_prediction();
  return project(step, negligible);
}

template <int dim>
AdvectionReport AdvectionVelocity<dim>::project(const StepTime& step, double negligible) {
  auto& fluid = *components_.fluid;
  auto& coupling = *components_.coupling;
  fluid.set_coupled_velocity(coupling.effective_velocity(*components_.solids));
  CoupledSolution solution;
  solution.rhs.pressure = make_vector(fluid.pressure_map());
  fluid.divergence(*solution.rhs.pressure);
  coupling.add_effective_divergence(*components_.solids, *solution.rhs.pressure);
  const BlockSystem& blocks = system_.blocks(0, false);
  const double incompatibility = relative_part_removed(blocks.null_space, *solution.rhs.pressure);
  solution.unknowns.pressure = make_vector(fluid.pressure_map());
  components_.strategy->prepare(blocks);
  SolveRequest request = solve_request(fluid, "F2", tolerance_, step, step.dt);
  request.negligible_pressure_residual = std::max(request.negligible_pressure_residual, negligible);
  gas_.solve_advection(step.dt, blocks, request, solution);
  gas_.project(*solution.unknowns.pressure, solution.gas_pressure);
  return {solution.report, incompatibility};
}

template class AdvectionVelocity<2>;
template class AdvectionVelocity<3>;

}  // namespace lockstep
