// Bodies at rest on others: how far a load goes, how deep an overlap is seen.
#include <gtest/gtest.h>

#include "contact_world.hpp"

namespace lockstep::test {
namespace {

template <typename T>
class Resting : public ::testing::Test {
 protected:
  void SetUp() override {
    if (world_communicator()->getSize() > 1)
      GTEST_SKIP();
  }
};
using Dimensions = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(Resting, Dimensions);

/// n boxes upon each other, of which each second one from the floor on has `ratio` times the mass
/// of the others, one step after they were let go.
template <int dim>
World<dim> column_after_a_step(int n, double ratio, double dt) {
  std::vector<RigidBody<dim>> bodies;
  for (int i = 0; i < n; ++i) {
    bodies.push_back(rough(box<dim>(4 * h, up<dim>((2 + 4 * i) * h), 4 * h), 0.5));
    const double factor = i % 2 == 0 ? ratio : 1;
    bodies.back().density *= factor;
    bodies.back().mass *= factor;
    bodies.back().inertia *= factor;
  }
  World<dim> world(bodies, up<dim>(-g));
  GaussSeidelOptions options;
  options.sweeps = 5000;
  options.tolerance = 1e-6;
  world.contact = GaussSeidelContact<dim>(options, cube_walls<dim>(), h);
  world.step(dt);
  return world;
}

/// From rest all of a column falls at once, and the floor is to stop it in the same step, given
/// sweeps enough: every face is held at its ends.
TYPED_TEST(Resting, TheFloorCarriesAllOfAColumn) {
  constexpr int dim = TypeParam::value;
  const int n = 20, n_at_a_face = dim == 2 ? 2 : 4;
  const double dt = 0.01;
  const World<dim> world = column_after_a_step<dim>(n, 1, dt);
  EXPECT_GE(world.velocity_report.n_contacts, n * n_at_a_face);
  for (int i = 0; i < n; ++i)
    EXPECT_LT(world.state(i).velocity.norm(), 0.01 * g * dt) << i;
}

/// A load goes up and down through light bodies. By plain sweeps a twentieth of g dt is left after
/// 4000 of them.
TYPED_TEST(Resting, LightBodiesCarryHeavyOnes) {
  constexpr int dim = TypeParam::value;
  const double dt = 0.01;
  const World<dim> world = column_after_a_step<dim>(6, 0.1, dt);
  for (int i = 0; i < 6; ++i)
    EXPECT_LT(world.state(i).velocity.norm(), 1e-4 * g * dt) << i;
}

/// The floor is one face far larger than the box, whose lower side is in it by more than is watched
/// of gaps, and by less than is recognised of overlaps.
TYPED_TEST(Resting, AnOverlapWithACoarseFloorIsSeenAndPushedOut) {
  constexpr int dim = TypeParam::value;
  const double depth = 0.3 * h;
  World<dim> world({fixed(box<dim>(40 * h, up<dim>(-20 * h), 100 * h)),
                    box<dim>(4 * h, up<dim>(2 * h - depth), 2 * h)},
                   up<dim>(-g));
  EXPECT_NEAR(world.overlap(), depth, 1e-12);
  world.run(1, 0.01);
  EXPECT_LT(world.overlap(), 0.06 * h);
  EXPECT_NEAR(world.state(1).center_of_mass[dim - 1], 2 * h, 0.06 * h);
}

/// Friction takes a box along until it is as fast as the belt, and brakes it when the belt stops.
TYPED_TEST(Resting, AMovingFloorCarriesWhatLiesOnIt) {
  constexpr int dim = TypeParam::value;
  const double friction = 0.5, speed = 1, stop = 0.495;
  World<dim> world({rough(box<dim>(4 * h, up<dim>(2 * h), 2 * h), friction)}, up<dim>(-g));
  world.contact = GaussSeidelContact<dim>(
      {}, cube_walls<dim>(), h, [&](int axis, int end, double time) -> Point<dim> {
        EXPECT_EQ(axis, dim - 1);
        EXPECT_EQ(end, 0);
        return time < stop ? Point<dim>(speed * Point<dim>::Unit(0)) : Point<dim>::Zero();
      });
  const double round_off = 1e-3 * speed;
  world.run(0.1, 0.01);
  EXPECT_NEAR(world.state(0).velocity[0], friction * g * 0.1, round_off);
  world.run(0.3, 0.01);
  EXPECT_NEAR(world.state(0).velocity[0], speed, round_off);
  world.run(0.2, 0.01);  // eleven steps end after the stop
  EXPECT_NEAR(world.state(0).velocity[0], speed - friction * g * 0.11, round_off);
  EXPECT_NEAR(world.state(0).angular_velocity.norm(), 0, round_off / h);
}

/// A plank of about a cell; lengths in its width.
RigidBody<3> plank(const Point<3>& size, double spacing, double z) {
  constexpr double width = 0.8 * h;
  return make_body<3>(box_surface<3>(width * size, width * spacing), Point<3>(0, 0, width * z));
}

/// Flush with another that it lies across, whatever their meshes: edges cross, and vertices beside
/// a rim are outside.
TEST(Planks, RestAcrossEachOther) {
  if (world_communicator()->getSize() > 1)
    GTEST_SKIP();
  for (const double length : {1.1, 1.4, 2.0, 4.0}) {
    for (const double spacing : {0.5, 0.875, 10.0}) {
      for (const double friction : {0.0, 0.5}) {
        World<3> world({rough(plank({1, length, 1}, spacing, 0.5), friction),
                        fixed(plank({1.3 * std::sqrt(length), 1, 1}, spacing, -0.5))},
                       up<3>(-g));
        const Point<3> start = world.state(0).center_of_mass;
        world.run(0.6, 0.01);
        EXPECT_LT((world.state(0).center_of_mass - start).norm(), 1e-4 * h)
            << length << " " << spacing << " " << friction;
        EXPECT_LT(world.state(0).angular_velocity.norm(), 1e-3)
            << length << " " << spacing << " " << friction;
      }
    }
  }
}

/// Head on and without friction, two of one mass that cross go on as one, and neither turns.
TEST(Planks, DoNotTurnWhenTheyMeetInTheMiddle) {
  if (world_communicator()->getSize() > 1)
    GTEST_SKIP();
  for (const double length : {1.05, 1.1, 1.2, 1.4}) {
    World<3> world({moving(plank({1, length, 1}, 0.875, 0.5), Point<3>(0, 0, -0.5)),
                    plank({length, 1, 1}, 0.875, -0.5)},
                   Point<3>::Zero());
    world.step(0.01);
    for (int i = 0; i < 2; ++i) {
      EXPECT_NEAR(world.state(i).velocity[2], -0.25, 1e-6) << length;
      EXPECT_LT(world.state(i).angular_velocity.norm(), 1e-5) << length;
    }
  }
}

}  // namespace
}  // namespace lockstep::test
