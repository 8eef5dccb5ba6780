#pragma once
#include <Tpetra_Vector.hpp>
#include <cmath>

#include "../mac/mac_cases.hpp"
#include "linear/conjugate_gradients.hpp"
#include "linear/null_space.hpp"
#include "multigrid/pressure_layout.hpp"

namespace lockstep::test {

/// A fluid with its pressure block as a system without solid.
template <int dim>
struct Problem {
  std::unique_ptr<MacFluid<dim>> fluid;
  BlockSystem system;

  Problem(Case<dim>& scene, const std::shared_ptr<const SurfaceSnapshot<dim>>& surface)
      : fluid(scene.make()) {
    fluid->set_geometry(surface, BlockedFaces<dim>());
    system.set_blocks(fluid->pressure_block());
    const PressureRegions& regions = fluid->regions();
    std::vector<RCP<const Vector>> vectors;
    for (int region = 0; region < regions.n_regions; ++region) {
      if (regions.has_dirichlet[region])
        continue;
      const auto indicator = make_vector(fluid->pressure_map());
      for (std::size_t row = 0; row < regions.of_unknown.size(); ++row) {
        if (regions.of_unknown[row] == region)
          indicator->replaceLocalValue(static_cast<int>(row), 1.0);
      }
      indicator->scale(1 / indicator->norm2());
      vectors.push_back(indicator);
    }
    system.null_space = system.pressure_null_space = null_space_of(vectors);
  }
};

/// A right-hand side in the range of A with smooth and rough parts.
template <int dim>
RCP<Vector> right_hand_side(const Problem<dim>& problem) {
  const auto rhs = pressure_vector<dim>(*problem.fluid, [](const Point<dim>& x) {
    return wavy<dim>(x) + 0.3 * std::sin(1e3 * x[0] + 3e3 * x[1]) +
           0.1 * std::cos(2e3 * x[dim - 1]);
  });
  project_out(problem.system.null_space, *rhs);
  return rhs;
}

/// The d.(A d) of a few iterations of the kernels is that of the fluid's own operator, which knows
/// neither slots nor ghosts.
template <int dim>
void expect_products_of_the_operator(const Problem<dim>& problem, const PressureLayout& layout,
                                     ConjugateGradientKernels& kernels) {
  Vector r(layout.map()), x(layout.map()), d(problem.fluid->pressure_map()), product(d.getMap());
  layout.to_layout(*right_hand_side(problem), r);
  double rr = r.dot(r), rz = kernels.precondition(r, std::sqrt(rr)), beta = 0;
  for (int iteration = 0; iteration < 5; ++iteration) {
    const double found = kernels.advance_direction(beta);
    layout.from_layout(kernels.direction(), d);
    apply(*problem.system.pressure_block(), d, product);
    const double expected = d.dot(product);
    ASSERT_NEAR(found, expected, 1e-11 * expected) << "iteration " << iteration;
    rr = kernels.advance(rz / found, x, r);
    const double next = kernels.precondition(r, std::sqrt(rr));
    beta = next / rz;
    rz = next;
  }
}

/// A plate along a plane of cell faces of odd number, so that it cuts coarse cells of the first
/// level, with a gap around it.
template <int dim>
std::shared_ptr<const SurfaceSnapshot<dim>> plate(double h, double where) {
  Solids<dim> solids;
  Point<dim> size = Point<dim>::Constant(0.7);
  Point<dim> center = Point<dim>::Constant(0.5);
  center[0] = where;
  solids.add(plate_surface<dim>(size, 0, h), center, false);
  return solids.snapshot();
}

}  // namespace lockstep::test
