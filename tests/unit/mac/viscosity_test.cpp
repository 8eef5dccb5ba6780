#include <gtest/gtest.h>

#include <Tpetra_CrsMatrix.hpp>
#include <cmath>

#include "viscous_cases.hpp"

namespace lockstep::test {
namespace {

Vector ones(const ViscousSystem<2>& system) {
  Vector result(system.map);
  result.putScalar(1);
  return result;
}

TEST(Viscosity, TaylorGreenDecaysAtItsRate) {
  const int n = 32;
  const double h = 1.0 / n, dt = 0.01, viscosity = 0.2, density = 2, k = 2 * M_PI;
  Case<2> scene({n, n}, h);
  scene.all_periodic();
  scene.fluid.set("Density", density);
  scene.fluid.set("Viscosity", viscosity);
  scene.fluid.set("Velocity",
                  formulas({"sin(2*_pi*x)*cos(2*_pi*y)", "-cos(2*_pi*x)*sin(2*_pi*y)"}));
  const auto fluid = scene.make();
  fluid->set_geometry(nullptr, BlockedFaces<2>());
  fluid->begin_prediction();
  const double before = fluid->audit()->kinetic_energy();
  EXPECT_NEAR(before, 0.25 * density, 1e-12);
  Momentum<2> impulse;
  viscous_step(*fluid, dt, impulse);
  // Backward Euler of the discrete eigenvalue 2 (2 - 2 cos kh)/h^2, which is 2 k^2 to second order.
  const double eigenvalue = 2 * (2 - 2 * std::cos(k * h)) / (h * h);
  const double factor = 1 / (1 + dt * viscosity / density * eigenvalue);
  EXPECT_NEAR(fluid->audit()->kinetic_energy() / before, factor * factor, 1e-11);
  EXPECT_NEAR(eigenvalue / (2 * k * k), 1, 0.005);
  EXPECT_LT(impulse.linear.norm(), 1e-12);
}

// An inflow pulls by the velocity that comes in, wherever within faces its opening ends.
TEST(Viscosity, AnOpeningPullsByWhatComesIn) {
  const auto pull = [](double lower, double upper) {
    Case<2> scene({8, 8}, 1. / 8);
    scene.side("x lower", "inflow", {2, 0}).side("x upper", "open");
    ParameterList& opening = scene.domain.sublist("Sides").sublist("x lower").sublist("Opening");
    opening.set("Lower", numbers({0.0, lower})).set("Upper", numbers({0.0, upper}));
    scene.fluid.set("Viscosity", 0.3);
    const auto fluid = scene.make();
    fluid->set_geometry(nullptr, BlockedFaces<2>());
    fluid->begin_prediction();
    return fluid->viscosity()->viscous_system()->wall_force->dot(
        ones(*fluid->viscosity()->viscous_system()));
  };
  const double of_four = pull(0.25, 0.75);
  EXPECT_NEAR(of_four, 0.3 * 2 * 4, 1e-12);
  for (const double upper : {0.3, 0.32, 0.6, 0.74})
    EXPECT_NEAR(pull(0.25, upper), of_four * (upper - 0.25) / 0.5, 1e-12);
}

// Faces at seams and open sides have half of their volume outside.
TEST(Viscosity, AnInflowPullsAlikeAtSeamsAndSides) {
  for (const bool periodic : {true, false}) {
    Case<2> scene({8, 8}, 1. / 8);
    if (periodic)
      scene.side("x lower", "periodic").side("x upper", "periodic");
    else
      scene.side("x lower", "open").side("x upper", "open");
    scene.side("y lower", "inflow", {1, 1}).side("y upper", "open");
    scene.fluid.set("Viscosity", 0.3);
    const auto fluid = scene.make();
    fluid->set_geometry(nullptr, BlockedFaces<2>());
    fluid->begin_prediction();
    const auto system = fluid->viscosity()->viscous_system();
    GlobalIndex along = 0, across = 0;
    const auto force = system->wall_force->getData();
    for (const double value : force) {
      if (value == 2 * 0.3)
        along += 1;  // half a cell away, over a whole one
      else if (value == 0.3)
        across += 1;  // a cell away; or over half a cell, at an open side
      else
        EXPECT_EQ(value, 0);
    }
    EXPECT_EQ(sum_all(world(), along), periodic ? 8 : 7);
    EXPECT_EQ(sum_all(world(), across), periodic ? 8 : 10);
  }
}

TEST(Viscosity, InviscidFluidHasNoSystem) {
  Case<2> scene({8, 8}, 0.1);
  const auto fluid = scene.make();
  fluid->set_geometry(nullptr, BlockedFaces<2>());
  EXPECT_EQ(fluid->viscosity(), nullptr);
}

/// Impulse of the fluid on the solids, at rest, in a step.
template <int dim>
Momentum<dim> impulse_of_links(MacFluid<dim>& fluid, const ViscousSystem<dim>& system, double dt) {
  const auto now = fluid.viscosity()->viscous_system();
  const auto u = now->velocity->getData();
  Momentum<dim> sum;
  for (const ViscousCouplingTerm<dim>& link : system.links)
    sum.add(link.position, link.direction, -dt * link.coefficient * u[link.row]);
  return sum_over_ranks(sum, world());
}

template <int dim>
void expect_closed_ledger(const std::string& x_type) {
  Index<dim> cells;
  cells.fill(20);
  Case<dim> scene(cells, 0.05);
  scene.fluid.set("Density", 1.5);
  scene.fluid.set("Viscosity", 0.7);
  scene.side("x lower", x_type,
             x_type == "inflow" ? Point<dim>(Point<dim>::Unit(0)) : Point<dim>::Zero());
  scene.side("x upper", "open")
      .side("y upper", "wall", Point<dim>::Unit(0))
      .side("y lower", "slip wall");
  const auto fluid = scene.make();
  Solids<dim> solids;
  solids.add(ball_surface<dim>(0.17, 0.05), Point<dim>::Constant(0.62), true);
  solids.add(plate_surface<dim>(Point<dim>::Constant(0.45), 1, 0.05), Point<dim>::Constant(0.31),
             false);
  fluid->set_geometry(solids.snapshot(), BlockedFaces<dim>());
  fluid->begin_prediction();
  fluid->set_prediction(wavy_velocity<dim>);
  const double dt = 0.02;
  const Momentum<dim> before = fluid->audit()->momentum();
  const auto system = fluid->viscosity()->viscous_system();
  Momentum<dim> given;
  viscous_step(*fluid, dt, given);
  given += impulse_of_links(*fluid, *system, dt);
  const Momentum<dim> gained = fluid->audit()->momentum() - before;
  EXPECT_GT(given.linear.norm(), 1e-3);
  EXPECT_LT((gained.linear - given.linear).norm(), 1e-12 * before.linear.norm() + 1e-12);
  EXPECT_LT((gained.angular - given.angular).norm(), 1e-12 * before.angular.norm() + 1e-12);

  // K is symmetric and positive; of a constant it is what sides and links pull.
  Vector x(system->map), y(system->map), kx(system->map), ky(system->map);
  const auto fill = [](Vector& v, double phase) {
    const auto values = v.getDataNonConst();
    for (std::size_t i = 0; i < static_cast<std::size_t>(values.size()); ++i)
      values[i] = std::sin(
          phase * (1.0 + static_cast<double>(v.getMap()->getGlobalElement(static_cast<int>(i)))));
  };
  fill(x, 0.7);
  fill(y, 1.3);
  system->stiffness->apply(x, kx);
  system->stiffness->apply(y, ky);
  EXPECT_NEAR(y.dot(kx), x.dot(ky), 1e-12 * x.dot(kx));
  EXPECT_GT(x.dot(kx), 0);
}
TEST(Viscosity, LedgerCloses2D) {
  expect_closed_ledger<2>("wall");
  expect_closed_ledger<2>("inflow");
}
TEST(Viscosity, LedgerCloses3D) {
  expect_closed_ledger<3>("inflow");
}

TEST(Viscosity, LinksEndOnAPlate) {
  // A plate at y = 1.8 h above the second row of x velocities (at 1.5 h).
  Case<2> scene({8, 4}, 1.0);
  scene.all_periodic();
  scene.side("y lower", "slip wall").side("y upper", "slip wall");
  scene.fluid.set("Viscosity", 3.0);
  const auto fluid = scene.make();
  Solids<2> solids;
  solids.add(plate_surface<2>(Point<2>(20, 0), 1, 1.0), Point<2>(4, 1.8), false);
  fluid->set_geometry(solids.snapshot(), BlockedFaces<2>());
  const auto system = fluid->viscosity()->viscous_system();
  int below = 0, above = 0, coupled = 0;
  for (const ViscousCouplingTerm<2>& link : system->links) {
    if (link.direction == 1) {
      // The y velocities beside the coupled ones at y = 2 h.
      EXPECT_TRUE(link.coupled_volume >= 0 || link.remote_volume);
      EXPECT_DOUBLE_EQ(link.coefficient, 3.0);
      ++coupled;
      continue;
    }
    EXPECT_NEAR(link.point.position[1], 1.8, 1e-12);
    EXPECT_NEAR((link.end - link.point.position).norm(), 0, 1e-12);
    EXPECT_NEAR(link.point.position[0], link.position[0], 1e-12);
    // mu area / distance, at 0.3 h and 0.7 h.
    EXPECT_NEAR(link.coefficient, 3.0 / (link.position[1] < 1.8 ? 0.3 : 0.7), 1e-12);
    ++(link.position[1] < 1.8 ? below : above);
  }
  EXPECT_EQ(sum_all(world(), GlobalIndex(below)), 8);
  EXPECT_EQ(sum_all(world(), GlobalIndex(above)), 8);
  EXPECT_EQ(sum_all(world(), GlobalIndex(coupled)), 16);
}

// Solids are not repeated beyond periodic sides: a body that turns has its velocity where it is.
TEST(Viscosity, LinksAcrossASeamEndWhereTheSolidIs) {
  for (const double plate : {7.8, 0.2}) {
    Case<2> scene({8, 4}, 1.0);
    scene.all_periodic();
    scene.fluid.set("Viscosity", 3.0);
    const auto fluid = scene.make();
    Solids<2> solids;
    solids.add(plate_surface<2>(Point<2>(0, 20), 0, 1.0), Point<2>(plate, 2), false);
    fluid->set_geometry(solids.snapshot(), BlockedFaces<2>());
    const auto system = fluid->viscosity()->viscous_system();
    int left = 0, right = 0;
    for (const ViscousCouplingTerm<2>& link : system->links) {
      if (link.direction == 0)
        continue;  // beside the coupled faces of the seam
      const double distance =
          link.position[0] > 4 ? plate == 0.2 ? 0.7 : 0.3 : (plate == 0.2 ? 0.3 : 0.7);
      EXPECT_NEAR(link.point.position[0], plate, 1e-12);
      EXPECT_NEAR((link.end - link.point.position).norm(), 0, 1e-12);
      EXPECT_NEAR(std::abs(link.reach[0]), distance, 1e-12);
      EXPECT_NEAR(link.coefficient, 3.0 / distance, 1e-12);
      ++(link.position[0] > 4 ? left : right);
    }
    EXPECT_EQ(sum_all(world(), GlobalIndex(left)), 4) << plate;
    EXPECT_EQ(sum_all(world(), GlobalIndex(right)), 4) << plate;
  }
}

// The face between two cells that solids fill, in the gap between those, across the seam.
TEST(Viscosity, HiddenSolidsAcrossASeamPull) {
  Case<2> scene({8, 8}, 1.0);
  scene.all_periodic();
  scene.fluid.set("Viscosity", 3.0);
  const auto fluid = scene.make();
  Solids<2> solids;
  for (const double y : {1.5, 2.5})
    solids.add(box_surface<2>(Point<2>(0.4, 0.4), 1.0), Point<2>(0.5, y), true);
  fluid->set_geometry(solids.snapshot(), BlockedFaces<2>());
  const auto system = fluid->viscosity()->viscous_system();
  GlobalIndex found = 0;
  for (const ViscousCouplingTerm<2>& link : system->links)
    found += link.direction == 1 && (link.position - Point<2>(7.5, 2)).norm() < 1e-12 &&
             (link.end - Point<2>(0.5, 2)).norm() < 1e-12;
  EXPECT_EQ(sum_all(world(), found), 1);
}

TEST(Viscosity, CouetteFlowIsLinear) {
  // The lid moves; after a step many diffusion times long the flow is u = y.
  Case<2> scene({4, 8}, 0.125);
  scene.side("x lower", "periodic").side("x upper", "periodic");
  scene.side("y upper", "wall", Point<2>(1, 0));
  scene.fluid.set("Viscosity", 1.0).set("Density", 1.0);
  const auto fluid = scene.make();
  fluid->set_geometry(nullptr, BlockedFaces<2>());
  fluid->begin_prediction();
  Momentum<2> impulse;
  viscous_step(*fluid, 1e9, impulse);
  const auto& grid = fluid->domain().grid;
  grid.for_each_owned_face(0, [&](int cell) {
    EXPECT_NEAR(fluid->prediction()[0][cell], grid.face_center(0, cell)[1], 1e-6);
  });
}

}  // namespace
}  // namespace lockstep::test
