#include "support.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>
#include <algorithm>
#include <cmath>

namespace lockstep::test {

namespace {

template <int dim>
RCP<Vector> solved(const SolidSystem<dim>& system, double dt, bool for_positions,
                   const Reduction& constraints) {
  const auto momentum = system.explicit_momentum(0, dt);
  if (for_positions)
    system.add_midpoint_correction(dt, *momentum);
  return system.velocity_of(*momentum, dt, constraints);
}

}  // namespace

template <int dim>
void Alone<dim>::step(double dt) {
  system.begin_step(time, dt);
  const auto half = solved(system, dt / 2, true, system.constraints(time, time + dt));
  system.limit_motion(dt, *half);
  system.move(*half, time, dt);
  time += dt;
  system.set_velocity(*solved(system, dt, false, system.constraints(time, time)));
}

template struct Alone<2>;
template struct Alone<3>;

double order_of_motion(const std::function<std::unique_ptr<DeformableSolids<2>>()>& make) {
  const auto reach_at_end = [&](int n_steps) {
    Alone<2> alone(make());
    for (int i = 0; i < n_steps; ++i)
      alone.step(0.01 / n_steps);
    double right = 0;
    for (const auto& x : alone.solids.surface().vertices)
      right = std::max(right, x.x());
    return right;
  };
  const double coarse = reach_at_end(200), middle = reach_at_end(400), fine = reach_at_end(800);
  return std::log2(std::abs((coarse - middle) / (middle - fine)));
}

}  // namespace lockstep::test
