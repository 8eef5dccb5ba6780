// Pressures next to a free surface, in the fluid's operator and in the multigrid's layout.
#include <gtest/gtest.h>

#include <cmath>

#include "../mac/liquid_cases.hpp"
#include "multigrid_cases.hpp"

namespace lockstep::test {
namespace {

/// As the coupling `flux` has them: any multiple of 2^-20.
template <int dim>
struct PartlyOpenFaces : OpenFractionRule<dim> {
  double open_fraction(const ControlVolume<dim>& volume, bool blocked,
                       const SurfaceSnapshot<dim>&) const override {
    return blocked ? 0 : 1 - std::ldexp(12345 + volume.id % 4321, -20);
  }
};

/// The surface stands above centres of cells by a small part of h, a body in it.
template <int dim>
void expect_the_same_operator(double height) {
  const int n = 16;
  Case<dim> scene(cube<dim>(n), 1.0 / n);
  scene.fluid.set("Density", 1.7).set("Gravity", components<dim>(-Point<dim>::Unit(1)));
  add_level<dim>(scene, (8.5 + height) / n);
  const auto fluid = make_liquid<dim>(scene);
  Solids<dim> solids;
  solids.add(ball_surface<dim>(0.21, 0.05), Point<dim>::Constant(0.48), true);
  fluid->set_geometry(solids.snapshot(), PartlyOpenFaces<dim>());
  BlockSystem system;
  system.set_blocks(fluid->pressure_block());
  const auto layout = PressureLayout::make(system, {}, nullptr);

  const auto x = pressure_vector<dim>(
      *fluid, [](const Point<dim>& at) { return 1 + 0.3 * std::sin(1e3 * at[0] + 3e3 * at[1]); });
  Vector product(x->getMap()), found(x->getMap());
  apply(*system.pressure_block(), *x, product);
  Vector x_there(layout->map()), product_there(layout->map());
  layout->to_layout(*x, x_there);
  apply(*layout->pressure_block(), x_there, product_there);
  layout->from_layout(product_there, found);
  found.update(-1, product, 1);
  const double unit = stencil_of(system.pressure_block())->unit;
  EXPECT_LT(found.normInf(), 1e-15 * (8 / height + 8) * unit) << height;
}

TEST(StiffCells, TheLayoutHasTheFluidsOperator) {
  for (const double height : {0.3, 0.02, 1e-3, 1e-5}) {
    expect_the_same_operator<2>(height);
    expect_the_same_operator<3>(height);
  }
}

}  // namespace
}  // namespace lockstep::test
