#include "support.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>

#include "solve/soft/exact_inverse.hpp"

namespace lockstep::test {

namespace {

template <int dim>
RCP<Vector> solved(const SolidSystem<dim>& system, double dt, bool for_positions,
                   const RCP<const Vector>& locked) {
  const auto given = system.explicit_momentum(0, dt);
  if (for_positions)
    system.add_midpoint_correction(dt, 1, *given);
  if (!locked.is_null())
    apply(*system.unlocked_block(Teuchos::null, dt), *locked, *given, -1, 1);
  const auto momentum = make_vector(system.map());
  momentum->elementWiseMultiply(1, *system.free_mask(), *given, 0);
  const auto velocity = make_vector(system.map());
  apply(*exact_inverse(system.solid_block(Teuchos::null, dt), "solids"), *momentum, *velocity);
  if (!locked.is_null())
    velocity->update(1, *locked, 1);
  return velocity;
}

}  // namespace

template <int dim>
void Alone<dim>::step(double dt) {
  system.begin_step(time, dt);
  const auto half = solved(system, dt / 2, true, system.locked_velocity(time, time + dt));
  system.limit_motion(dt, *half);
  system.move(*half, time, dt);
  time += dt;
  system.set_velocity(*solved(system, dt, false, system.locked_velocity(time, time)));
}

template struct Alone<2>;
template struct Alone<3>;

}  // namespace lockstep::test
