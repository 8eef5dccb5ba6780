#include "support.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>

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

}  // namespace lockstep::test
