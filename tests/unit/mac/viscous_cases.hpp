#pragma once
#include <Tpetra_CrsMatrix.hpp>

#include "liquid_cases.hpp"

namespace lockstep::test {

/// (M + dt K) x, every solid at rest.
struct ViscousOperator {
  const CrsMatrix& stiffness;
  const Vector& mass;
  double dt;
  void operator()(const Vector& x, Vector& y) const {
    stiffness.apply(x, y);
    y.elementWiseMultiply(1, mass, x, dt);
  }
};

template <int dim>
void viscous_step(MacFluid<dim>& fluid, double dt, Momentum<dim>& impulse) {
  const auto system = fluid.viscosity()->viscous_system();
  Vector rhs(system->map), solution(system->map);
  rhs.elementWiseMultiply(1, *system->mass, *system->velocity, 0);
  rhs.update(dt, *system->wall_force, 1);
  conjugate_gradients(ViscousOperator{*system->stiffness, *system->mass, dt}, rhs, solution, 1e-14);
  impulse = fluid.viscosity()->accept_viscous(solution, solution, dt);
}

}  // namespace lockstep::test
