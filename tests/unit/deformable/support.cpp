#include "support.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>

#include "linear/exact_inverse.hpp"

namespace lockstep::test {

namespace {

template <int dim>
RCP<Vector> solved(const SolidSystem<dim>& system, double dt) {
  const auto momentum = system.explicit_momentum(0, dt);
  momentum->elementWiseMultiply(1, *system.free_mask(), *momentum, 0);
  const auto velocity = make_vector(system.map());
  apply(*exact_inverse(system.solid_block(Teuchos::null, dt), "solids"), *momentum, *velocity);
  return velocity;
}

}  // namespace

template <int dim>
void Alone<dim>::step(double dt) {
  system.move(*solved(system, dt / 2), 0, dt);
  system.set_velocity(*solved(system, dt));
}

template struct Alone<2>;
template struct Alone<3>;

}  // namespace lockstep::test
