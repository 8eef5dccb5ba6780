// The viscous form beside air: that of the symmetric stress.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "support/dense.hpp"
#include "viscous_cases.hpp"

namespace lockstep::test {
namespace {

/// A ball of liquid in air: whatever moves as a solid is left alone, nothing gains energy, and the
/// fluid has what the ledger says.
template <int dim>
void expect_stress_of_a_blob() {
  Case<dim> scene(cube<dim>(16), 1.0 / 16);
  scene.fluid.set("Density", 1.5).set("Viscosity", 0.7);
  const Point<dim> center = Point<dim>::Constant(0.49);
  add_ball<dim>(scene, center, 0.3);
  const auto fluid = make_liquid<dim>(scene);
  fluid->set_geometry(nullptr, BlockedFaces<dim>());
  fluid->begin_prediction();
  const auto stiffness_of = [&](const std::function<Point<dim>(const Point<dim>&)>& velocity) {
    fluid->set_prediction(velocity);
    const auto system = fluid->viscosity()->viscous_system();
    Vector force(system->map);
    system->stiffness->apply(*system->velocity, force);
    return std::make_pair(force.normInf(), force.dot(*system->velocity));
  };
  const auto turning = [&](const Point<dim>& x) {
    Point<dim> u = Point<dim>::Constant(0.3);
    u[0] -= x[1] - center[1];
    u[1] += x[0] - center[0];
    return u;
  };
  EXPECT_LT(stiffness_of(turning).first, 1e-13);
  const auto growing = [&](const Point<dim>& x) { return Point<dim>(x - center); };
  EXPECT_GE(stiffness_of(growing).second, -1e-13);
  for (const double k : {1.0, 5.0, 20.0, 50.0})
    EXPECT_GT(stiffness_of([&](const Point<dim>& x) {
                Point<dim> u;
                for (int axis = 0; axis < dim; ++axis)
                  u[axis] = wavy<dim>(Point<dim>(k * x + Point<dim>::Unit(axis)));
                return u;
              }).second,
              0);
  const Momentum<dim> before = fluid->audit()->momentum();
  Momentum<dim> impulse;
  viscous_step(*fluid, 0.3, impulse);
  const Momentum<dim> gained = fluid->audit()->momentum() - before;
  EXPECT_LT((gained.linear - impulse.linear).norm(), 1e-12);
  EXPECT_LT((gained.angular - impulse.angular).norm(), 1e-12);
  // Nobody is there to give any.
  EXPECT_LT(impulse.linear.norm(), 1e-12);
  EXPECT_LT(impulse.angular.norm(), 1e-12);
}
TEST(StressAtAir, NothingHoldsABlob2D) {
  expect_stress_of_a_blob<2>();
}
TEST(StressAtAir, NothingHoldsABlob3D) {
  expect_stress_of_a_blob<3>();
}

/// The smallest eigenvalue of K in parts of the largest one.
template <int dim>
double smallest_of_largest(const ViscousSystem<dim>& system) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(dense(system.stiffness),
                                                             Eigen::EigenvaluesOnly);
  return eigen.eigenvalues().minCoeff() / eigen.eigenvalues().maxCoeff();
}

/// Liquid as ragged as cells allow: the union of balls, some of them cut by walls.
template <int dim>
Case<dim> balls_between_walls(const std::string& wall) {
  Case<dim> scene(cube<dim>(dim == 2 ? 14 : 8), 1.0);
  scene.fluid.set("Viscosity", 0.7);
  for (const std::string axis : {"x", "y", "z"})
    if (dim == 3 || axis != "z")
      scene.side(axis + " lower", wall).side(axis + " upper", wall);
  const double size = dim == 2 ? 14 : 8;
  ParameterList& liquid = scene.fluid.sublist("Free Surface").sublist("Liquid");
  for (int ball = 0; ball < 4; ++ball) {
    Point<dim> center;
    for (int a = 0; a < dim; ++a)
      center[a] = size * (0.5 + 0.5 * std::sin(3.1 * ball + 1.7 * a + 0.4));
    ParameterList& list = liquid.sublist("ball " + std::to_string(ball));
    list.set("Type", "ball").set("Radius", size * (0.16 + 0.03 * ball));
    list.set("Center", components<dim>(center));
  }
  return scene;
}

template <int dim>
void expect_definite_at_walls() {
  for (const std::string wall : {"wall", "slip wall"}) {
    Case<dim> scene = balls_between_walls<dim>(wall);
    const auto fluid = make_liquid<dim>(scene);
    fluid->set_geometry(nullptr, BlockedFaces<dim>());
    fluid->begin_prediction();
    EXPECT_GT(smallest_of_largest(*fluid->viscosity()->viscous_system()), -1e-14) << wall;
  }
}
// At walls, too, the form is that of the symmetric stress: what it lacked in 3D had an eigenvalue
// of -0.07 of the largest one.
TEST(StressAtAir, NothingGainsEnergyAtWalls2D) {
  expect_definite_at_walls<2>();
}
TEST(StressAtAir, NothingGainsEnergyAtWalls3D) {
  expect_definite_at_walls<3>();
}

// A body goes from the middle of a large drop out of it.
template <int dim>
void expect_definite_near_bodies() {
  const int n = dim == 2 ? 16 : 10;
  for (double distance = 0; distance < 0.6 * n; distance += dim == 2 ? 0.5 : 0.9) {
    Case<dim> scene(cube<dim>(n), 1.0);
    scene.fluid.set("Viscosity", 0.7);
    const Point<dim> center = Point<dim>::Constant(0.49 * n);
    add_ball<dim>(scene, center, 0.42 * n);
    const auto fluid = make_liquid<dim>(scene);
    Solids<dim> solids;
    Point<dim> place = center;
    place[0] += distance;
    place[1] += 0.4 * distance;
    solids.add(ball_surface<dim>(1.1, 0.5), place, true);
    fluid->set_geometry(solids.snapshot(), BlockedFaces<dim>());
    fluid->begin_prediction();
    EXPECT_GT(smallest_of_largest(*fluid->viscosity()->viscous_system()), -1e-14) << distance;
  }
}
TEST(StressAtAir, NothingGainsEnergyNearBodies2D) {
  expect_definite_near_bodies<2>();
}
TEST(StressAtAir, NothingGainsEnergyNearBodies3D) {
  expect_definite_near_bodies<3>();
}

/// A jet comes in through an opening and flies on, all of it as fast: nothing pulls, though the air
/// is beside it from the opening on. If it thins out instead, sides and fluid exchange what the
/// ledger says.
template <int dim>
void expect_jet_to_fly_on() {
  Case<dim> scene(cube<dim>(12), 1.0 / 12);
  scene.fluid.set("Density", 1.5).set("Viscosity", 0.7);
  const Point<dim> speed = 2 * Point<dim>::Unit(0);
  for (const std::string axis : {"y", "z"})
    if (dim == 3 || axis != "z")
      scene.side(axis + " lower", "slip wall").side(axis + " upper", "slip wall");
  scene.side("x lower", "inflow", speed).side("x upper", "wall");
  Point<dim> lower = Point<dim>::Constant(1. / 3), upper = Point<dim>::Constant(2. / 3);
  lower[0] = -1;
  upper[0] = 0.5;
  ParameterList& opening = scene.domain.sublist("Sides").sublist("x lower").sublist("Opening");
  opening.set("Lower", components<dim>(lower)).set("Upper", components<dim>(upper));
  ParameterList& jet = scene.fluid.sublist("Free Surface").sublist("Liquid").sublist("jet");
  jet.set("Type", "box");
  jet.set("Lower", components<dim>(lower)).set("Upper", components<dim>(upper));
  const auto fluid = make_liquid<dim>(scene);
  fluid->set_geometry(nullptr, BlockedFaces<dim>());
  fluid->begin_prediction();
  fluid->set_prediction([&](const Point<dim>&) { return speed; });
  auto system = fluid->viscosity()->viscous_system();
  Vector force(*system->wall_force, Teuchos::Copy);
  system->stiffness->apply(*system->velocity, force, Teuchos::NO_TRANS, 1, -1);
  EXPECT_GT(system->wall_force->normInf(), 0.1);
  EXPECT_LT(force.normInf(), 1e-13);

  fluid->set_prediction(wavy_velocity<dim>);
  const Momentum<dim> before = fluid->audit()->momentum();
  Momentum<dim> impulse;
  viscous_step(*fluid, 0.03, impulse);
  const Momentum<dim> gained = fluid->audit()->momentum() - before;
  EXPECT_GT(impulse.linear.norm(), 1e-3);
  EXPECT_LT((gained.linear - impulse.linear).norm(), 1e-12);
  EXPECT_LT((gained.angular - impulse.angular).norm(), 1e-12);
}
TEST(StressAtAir, AJetFliesOn2D) {
  expect_jet_to_fly_on<2>();
}
TEST(StressAtAir, AJetFliesOn3D) {
  expect_jet_to_fly_on<3>();
}

}  // namespace
}  // namespace lockstep::test
