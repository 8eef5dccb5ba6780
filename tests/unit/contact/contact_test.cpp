#include <gtest/gtest.h>

#include <cmath>
#include <ctime>

#include "contact/register_contact.hpp"
#include "contact_world.hpp"
#include "parameters/validate.hpp"

namespace lockstep::test {
namespace {

template <typename T>
class ContactsOnRanks : public ::testing::Test {};
/// On one rank: several would each do the same.
template <typename T>
class Contacts : public ::testing::Test {
 protected:
  void SetUp() override {
    if (world_communicator()->getSize() > 1)
      GTEST_SKIP();
  }
};
using Dimensions = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(Contacts, Dimensions);
TYPED_TEST_SUITE(ContactsOnRanks, Dimensions);

TYPED_TEST(Contacts, ABallDroppedOnTheFloorRestsWithoutDrift) {
  constexpr int dim = TypeParam::value;
  World<dim> world({rough(ball<dim>(4 * h, up<dim>(6 * h)), 0.3)}, up<dim>(-g), cube_walls<dim>());
  world.run(3, 0.01);  // time to tip from a vertex onto a side
  const SolidState<dim> before = world.state(0);
  EXPECT_NEAR(before.center_of_mass[dim - 1], 4 * h, 0.15 * h);
  world.run(0.5, 0.01);
  EXPECT_LT((world.state(0).center_of_mass - before.center_of_mass).norm(), 0.01 * h);
  EXPECT_LT(world.overlap(), 0.06 * h);
}

TYPED_TEST(Contacts, ElasticBallsHeadOnKeepMomentumAndEnergy) {
  constexpr int dim = TypeParam::value;
  const Point<dim> x = Point<dim>::Unit(0);
  World<dim> world({moving<dim>(rough(ball<dim>(3 * h, -5 * h * x), 0, 1), 2 * x),
                    moving<dim>(rough(ball<dim>(3 * h, 5 * h * x), 0, 1), -1 * x)},
                   Point<dim>::Zero());
  const Momentum<dim> momentum = world.momentum();
  const double energy = world.energy();
  world.run(0.4, 0.02);
  EXPECT_LT((world.momentum().linear - momentum.linear).norm(), 1e-12 * momentum.linear.norm());
  EXPECT_NEAR(world.energy(), energy, 0.01 * energy);
  // Equal masses exchange their velocities.
  EXPECT_NEAR(world.state(0).velocity[0], -1, 0.05);
  EXPECT_NEAR(world.state(1).velocity[0], 2, 0.05);
}

TYPED_TEST(Contacts, WhatArrivesExactlyAtTheEndOfAStepStopsInTheNextWhateverTheRoundOff) {
  constexpr int dim = TypeParam::value;
  const double speed = 1, dt = 0.1 * h / speed;
  for (const double moved : {-1e-14, 0.0, 1e-14}) {
    World<dim> world(
        {moving<dim>(box<dim>(4 * h, up<dim>((2.2 + moved) * h), 2 * h), up<dim>(-speed))},
        Point<dim>::Zero(), cube_walls<dim>());
    world.step(dt);
    EXPECT_NEAR(world.state(0).velocity[dim - 1], -speed, 1e-9) << moved;
    world.step(dt);
    EXPECT_NEAR(world.state(0).velocity[dim - 1], 0, 1e-5) << moved;  // to the sweeps' tolerance
  }
}

TYPED_TEST(Contacts, AStackOfThreeBoxesStays) {
  constexpr int dim = TypeParam::value;
  std::vector<RigidBody<dim>> bodies;
  for (int i = 0; i < 3; ++i)
    bodies.push_back(rough(box<dim>(4 * h, up<dim>((2 + 4 * i) * h), 2 * h), 0.5));
  World<dim> world(bodies, up<dim>(-g), cube_walls<dim>());
  world.run(2, 0.01);
  for (int i = 0; i < 3; ++i) {
    EXPECT_LT((world.state(i).center_of_mass - up<dim>((2 + 4 * i) * h)).norm(), 0.1 * h) << i;
    EXPECT_LT(world.state(i).velocity.norm(), 1e-3) << i;
  }
}

/// A body that is locked, and hit hard all the time: no impulse helps it, so it is no measure of
/// how well others are to rest.
TYPED_TEST(Contacts, WhatCannotMoveTroublesNobody) {
  constexpr int dim = TypeParam::value;
  std::vector<RigidBody<dim>> bodies;
  for (int i = 0; i < 3; ++i)
    bodies.push_back(rough(box<dim>(4 * h, up<dim>((2 + 4 * i) * h), 2 * h), 0.5));
  const Point<dim> aside = 30 * h * Point<dim>::Unit(0);
  bodies.push_back(box<dim>(4 * h, aside + up<dim>(20 * h), 2 * h));
  bodies.back().locked.fill(true);
  bodies.push_back(fixed(box<dim>(4 * h, aside + up<dim>(40 * h), 2 * h)));
  bodies.back().script = [](double) {
    ScriptedMotion<dim> motion;
    motion.velocity = up<dim>(-100);
    return motion;
  };
  World<dim> alone(bodies, up<dim>(-g), cube_walls<dim>());
  bodies.back().pose.position = aside + up<dim>(24 * h);
  bodies.back().initial_pose = bodies.back().pose;
  World<dim> beside(bodies, up<dim>(-g), cube_walls<dim>());
  for (int n = 0; n < 20; ++n) {
    alone.step(0.01);
    beside.step(0.01);
    EXPECT_GT(alone.velocity_report.n_contacts, 0);
    EXPECT_EQ(beside.velocity_report.n_contacts, alone.velocity_report.n_contacts);
    for (int i = 0; i < 3; ++i)
      EXPECT_LT((beside.state(i).velocity - alone.state(i).velocity).norm(), 1e-12) << i;
  }
}

double cpu_seconds() {
  return double(std::clock()) / CLOCKS_PER_SEC;
}

/// Gravity turned by the angle of an incline along axis 0.
template <int dim>
Point<dim> inclined_gravity(double slope) {
  const double angle = std::atan(slope);
  return g * std::sin(angle) * Point<dim>::Unit(0) + up<dim>(-g * std::cos(angle));
}

TYPED_TEST(Contacts, ABoxOnAnInclineSticksOrSlides) {
  constexpr int dim = TypeParam::value;
  const double friction = 0.5, time = 0.5;
  for (const bool on_wall : {true, false}) {
    std::vector<RigidBody<dim>> bodies{rough(box<dim>(4 * h, up<dim>(2 * h), 2 * h), friction)};
    if (!on_wall) {
      bodies.push_back(rough(fixed(box<dim>(40 * h, up<dim>(-20 * h), 10 * h)), friction));
    }
    const auto walls = on_wall ? cube_walls<dim>() : std::vector<HalfSpace>();
    World<dim> sticking(bodies, inclined_gravity<dim>(0.45), walls);
    sticking.run(time, 0.01);
    EXPECT_LT(std::abs(sticking.state(0).center_of_mass[0]), 1e-3 * h) << on_wall;
    World<dim> sliding(bodies, inclined_gravity<dim>(0.6), walls);
    sliding.run(time, 0.01);
    const double acceleration =
        inclined_gravity<dim>(0.6)[0] + friction * inclined_gravity<dim>(0.6)[dim - 1];
    EXPECT_NEAR(sliding.state(0).velocity[0], acceleration * time, 0.01 * acceleration * time)
        << on_wall;
    EXPECT_NEAR(sliding.state(0).center_of_mass[0], acceleration * time * time / 2, 0.02 * h)
        << on_wall;
  }
}

/// Normal of a plate that lay with this side up at the start.
template <int dim>
Point<dim> plate_normal(const SolidSystem<dim>& solids, int plate) {
  const auto surface = solids.snapshot();
  const auto corners = surface->corners(surface->solids()[plate].simplex_begin);
  const auto start = plate_surface<dim>(Point<dim>::Constant(20 * h), dim - 1, 0.7 * h);
  std::array<Point<dim>, dim> start_corners;
  for (int k = 0; k < dim; ++k)
    start_corners[k] = start.vertices[start.simplices[0][k]];
  const double side = area_vector<dim>(start_corners)[dim - 1] > 0 ? 1 : -1;
  return side * area_vector<dim>(corners).normalized();
}

TYPED_TEST(Contacts, NoBallPassesAShell) {
  constexpr int dim = TypeParam::value;
  const double radius = 2 * h, dt = 0.01;
  for (const double speed : {0.5, 20.0, 300.0}) {  // 300 m/s: 15 radii a step
    for (const double weight : {0.0, 1.0}) {
      RigidBody<dim> sheet = plate<dim>(20 * h, Point<dim>::Zero());
      if (weight == 0)
        sheet = fixed(sheet);
      World<dim> world({moving<dim>(ball<dim>(radius, up<dim>(9.3 * h)), up<dim>(-speed)), sheet},
                       up<dim>(-g));
      for (int i = 0; i < 60; ++i) {
        world.step(dt);
        // Along the plate's own normal: it may have been turned.
        const auto surface = world.solids->snapshot();
        const Point<dim> normal =
            area_vector<dim>(surface->corners(surface->solids()[1].simplex_begin)).normalized();
        const double height =
            std::abs(normal.dot(world.state(0).center_of_mass - world.state(1).center_of_mass));
        ASSERT_GT(height, 0.9 * radius) << speed << " m/s, step " << i;
      }
    }
  }
}

TYPED_TEST(ContactsOnRanks, ImpulsesBalance) {
  constexpr int dim = TypeParam::value;
  std::vector<RigidBody<dim>> bodies;
  AngularVector<dim> spin = AngularVector<dim>::Constant(3);
  for (int i = 0; i < 6; ++i) {
    Point<dim> position = Point<dim>::Constant(8 * h) + 0.4 * h * Point<dim>::Random();
    position[0] += (i % 3 - 1) * 4.5 * h;
    position[dim - 1] += (i / 3 == 0 ? -1 : 1) * 2.5 * h;
    const Point<dim> velocity = 3 * (Point<dim>::Constant(8 * h) - position);
    bodies.push_back(moving<dim>(
        rough(i % 2 ? ball<dim>(2 * h, position) : box<dim>(3 * h, position, 3 * h), 0.4, 0.5),
        velocity, i * spin));
  }
  // Walls give what the report says, and nothing else changes momentum.
  World<dim> world(bodies, up<dim>(-g), cube_walls<dim>(16 * h));
  int n_contacts = 0;
  double given = 0;
  for (int i = 0; i < 40; ++i) {
    world.step(0.01);
    const Momentum<dim> change = world.contact_change;
    const Momentum<dim> wall = world.velocity_report.external_impulse;
    EXPECT_LT((change.linear - wall.linear).norm(), 1e-12 * world.momentum_scale());
    EXPECT_LT((change.angular - wall.angular).norm(), 1e-12 * world.momentum_scale());
    n_contacts += world.velocity_report.n_contacts;
    given += wall.linear.norm();
  }
  EXPECT_GT(n_contacts, 20);
  EXPECT_GT(given, 0);
}

TYPED_TEST(ContactsOnRanks, ResultsDoNotDependOnTheNumberOfRanks) {
  constexpr int dim = TypeParam::value;
  std::vector<RigidBody<dim>> bodies;
  for (int i = 0; i < 5; ++i) {
    Point<dim> position = Point<dim>::Constant(5 * h) + up<dim>(i * 3.5 * h);
    position[0] += 0.3 * i * h;
    bodies.push_back(rough(ball<dim>(2 * h, position), 0.3));
  }
  World<dim> together(bodies, up<dim>(-g), cube_walls<dim>(30 * h));
  World<dim> alone(bodies, up<dim>(-g), cube_walls<dim>(30 * h), own_communicator());
  together.run(0.5, 0.01);
  alone.run(0.5, 0.01);
  for (int i = 0; i < 5; ++i)
    EXPECT_EQ(together.state(i).center_of_mass, alone.state(i).center_of_mass);
}

TYPED_TEST(Contacts, OverlapIsPushedOutWithoutVelocity) {
  constexpr int dim = TypeParam::value;
  const Point<dim> x = Point<dim>::Unit(0);
  World<dim> world({ball<dim>(3 * h, -2.85 * h * x), ball<dim>(3 * h, 2.85 * h * x)},
                   Point<dim>::Zero());
  EXPECT_NEAR(world.overlap(), 0.3 * h, 0.05 * h);
  world.run(0.3, 0.01);
  EXPECT_LT(world.overlap(), 0.06 * h);
  EXPECT_LT(world.energy(), 1e-20);
}

TYPED_TEST(Contacts, AHundredBallsSettle) {
  constexpr int dim = TypeParam::value;
  const double radius = 4 * h;
  std::vector<RigidBody<dim>> bodies;
  const int n_across = dim == 2 ? 10 : 5;
  for (int i = 0; i < 100; ++i) {
    Point<dim> position = up<dim>((2.2 * (i / (dim == 2 ? 10 : 25)) + 1.2) * radius);
    position[0] = (2.1 * (i % n_across) + 1.2 + 0.1 * std::sin(i)) * radius;
    if (dim == 3)
      position[1] = (2.1 * (i / 5 % 5) + 1.2 + 0.1 * std::cos(i)) * radius;
    bodies.push_back(rough(ball<dim>(radius, position, h), 0.2));
  }
  World<dim> world(bodies, up<dim>(-g), cube_walls<dim>((2.1 * n_across + 2) * radius));
  const double start = cpu_seconds(), dt = 0.01;
  const int n_steps = dim == 2 ? 200 : 100;
  double deepest = 0;
  for (int i = 0; i < n_steps; ++i) {
    world.step(dt);
    deepest = std::max(deepest, world.position_report.deepest_overlap);
  }
  const double milliseconds = 1000 * (cpu_seconds() - start) / n_steps;
  EXPECT_LT(world.overlap(), 0.2 * h);
  double mean_speed = 0;
  for (const auto& state : world.solids->states())
    mean_speed += state.velocity.norm() / 100;
  EXPECT_LT(mean_speed, 0.5);
  std::printf(
      "%dD: %.1f ms a step, deepest overlap %.3f h, at the end %.3f h, mean speed %.3f m/s\n", dim,
      milliseconds, deepest / h, world.overlap() / h, mean_speed);
}

TEST(EdgeContacts, CrossedBoxesMeetAtTheirEdges) {
  // Two coarse boxes turned by 45 degrees about different axes: edge against edge, no vertex near.
  const double half = 2 * h;
  RigidBody<3> lower = fixed(box<3>(2 * half, Point<3>::Zero(), 10 * h));
  RigidBody<3> upper = box<3>(2 * half, Point<3>(0, 0, (2 * std::sqrt(2.0) + 0.5) * half), 10 * h);
  lower.initial_pose.orientation = lower.pose.orientation =
      rotation_of<3>(AngularVector<3>(std::atan(1.0), 0, 0));
  upper.pose.orientation = rotation_of<3>(AngularVector<3>(0, std::atan(1.0), 0));
  World<3> world({upper, lower}, up<3>(-g));
  double lowest = 1e300;
  for (int i = 0; i < 40; ++i) {
    world.step(0.01);
    lowest = std::min(lowest, world.state(0).center_of_mass[2]);
  }
  EXPECT_NEAR(lowest, 2 * std::sqrt(2.0) * half, 0.06 * h);
}

TEST(ContactRegistration, IsChosenByName) {
  ContactRegistry<2> contacts("contact model");
  register_contact(contacts);
  ParameterList list;
  validate(list, contacts.valid_parameters("gauss seidel"), Source());
  ContactSetting<2> setting;
  setting.comm = world_communicator();
  const auto model = contacts.create("gauss seidel", list, setting);
  EXPECT_EQ(model->name(), "gauss seidel");
}

TEST(ContactRegistration, RefusesASkinOfAnUnknownSolid) {
  ContactRegistry<2> contacts("contact model");
  register_contact(contacts);
  ParameterList list;
  list.sublist("Skins").sublist("curtain").set("Thickness", 0.01);
  validate(list, contacts.valid_parameters("gauss seidel"), Source());
  ContactSetting<2> setting;
  setting.comm = world_communicator();
  setting.solids = {"Ball", "curtain"};
  EXPECT_NO_THROW(contacts.create("gauss seidel", list, setting));
  setting.solids = {"Ball"};
  EXPECT_THROW(contacts.create("gauss seidel", list, setting), InputError);
}

}  // namespace
}  // namespace lockstep::test
