#include "stepping/step/coupled_solution.hpp"

#include <Tpetra_Vector.hpp>
#include <cmath>

namespace lockstep {

template <int dim>
RCP<Vector> last_pressure(const FluidDiscretization<dim>& fluid, const StepTime& step, double dt) {
  const RCP<Vector> pressure = fluid.last_scaled_pressure();
  if (step.last_dt > 0)
    pressure->scale(dt / step.last_dt);
  return pressure;
}

template <int dim>
RCP<Vector> impulse_at_rest(const Components<dim>& components, double dt) {
  const auto impulse = make_vector(components.solids->map());
  if (const auto* coupling = components.coupling->hydrostatics())
    coupling->add_impulse_at_rest(dt, *impulse);
  return impulse;
}

template <int dim>
SolveRequest solve_request(const FluidDiscretization<dim>& fluid, const std::string& name,
                           double tolerance, const StepTime& step, double dt) {
  const double speed = fluid.largest_speed() + dt * fluid.gravity().norm();
  const double area = std::pow(fluid.smallest_length(), dim - 1);
  const auto n_cells = static_cast<double>(fluid.pressure_map()->getGlobalNumElements());
  return {name, tolerance, 1e-15 * speed * area * std::sqrt(n_cells), step.number};
}

template RCP<Vector> last_pressure(const FluidDiscretization<2>&, const StepTime&, double);
template RCP<Vector> last_pressure(const FluidDiscretization<3>&, const StepTime&, double);
template RCP<Vector> impulse_at_rest(const Components<2>&, double);
template RCP<Vector> impulse_at_rest(const Components<3>&, double);
template SolveRequest solve_request(const FluidDiscretization<2>&, const std::string&, double,
                                    const StepTime&, double);
template SolveRequest solve_request(const FluidDiscretization<3>&, const std::string&, double,
                                    const StepTime&, double);

}  // namespace lockstep
