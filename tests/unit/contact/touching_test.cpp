#include <gtest/gtest.h>

#include "cloth_world.hpp"

namespace lockstep::test {
namespace {

template <typename T>
class Touching : public ::testing::Test {
 protected:
  void SetUp() override {
    if (world_communicator()->getSize() > 1)
      GTEST_SKIP();
  }
};
using Dimensions = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(Touching, Dimensions);

TYPED_TEST(Touching, WhatLiesExactlyOnASolidFromTheStartStaysThere) {
  // A sheet on a plate, which has two sides, and on a box; upside down, too.
  constexpr int dim = TypeParam::value;
  for (const bool on_plate : {true, false}) {
    for (const double upward : {1., -1.}) {
      std::vector<DeformableBody<dim>> cloths;
      cloths.push_back(sheet<dim>(5 * h, Point<dim>::Zero(), h));
      const RigidBody<dim> ground = on_plate ? plate<dim>(8 * h, Point<dim>::Zero())
                                             : box<dim>(8 * h, up<dim>(-4 * upward * h));
      ClothWorld<dim> world(std::move(cloths), {fixed(ground)}, up<dim>(-g * upward));
      for (int i = 0; i < 30; ++i) {
        world.step(0.01);
        ASSERT_EQ(n_crossings(*world.solids), 0) << i << on_plate << upward;
        const double height = upward * world.state(0).center_of_mass[dim - 1];
        ASSERT_GT(height, 0) << i << on_plate << upward;
        ASSERT_LT(height, 0.1 * h) << i << on_plate << upward;
      }
    }
  }
}

TYPED_TEST(Touching, ABodyMayLeaveWhatItLiesOn) {
  constexpr int dim = TypeParam::value;
  std::vector<DeformableBody<dim>> cloths;
  cloths.push_back(sheet<dim>(5 * h, Point<dim>::Zero(), h));
  cloths[0].velocity.assign(cloths[0].velocity.size(), up<dim>(2));
  ClothWorld<dim> world(std::move(cloths), {fixed(box<dim>(8 * h, up<dim>(-4 * h)))},
                        Point<dim>::Zero());
  for (int i = 0; i < 3; ++i)
    world.step(0.01);
  EXPECT_NEAR(world.state(0).velocity[dim - 1], 2, 1e-9);
}

/// A vertex on a triangle.
TEST(Touching3D, OnlyTheWayToTheOtherSideIsAnImpact) {
  const PrimitivePoints<3> before{Point<3>(0.2, 0.2, 0), Point<3>(0, 0, 0), Point<3>(1, 0, 0),
                                  Point<3>(0, 1, 0)};
  PrimitivePoints<3> after = before;
  const auto impact = [&](double moved, double side) {
    after[0].z() = moved;
    return first_impact<3>(
        PrimitiveKind::vertex_simplex, before, after,
        [side](const PrimitiveWeights<3>&, const Point<3>&) { return Point<3>(0, 0, side); });
  };
  for (const double side : {1., -1.}) {
    EXPECT_FALSE(impact(side, side));
    ASSERT_TRUE(impact(-side, side));
    EXPECT_EQ(impact(-side, side)->time, 0);
    EXPECT_EQ(impact(-side, side)->normal.z(), side);
    EXPECT_FALSE(impact(-side, 0));
    EXPECT_FALSE(impact(0, side));
  }
}

}  // namespace
}  // namespace lockstep::test
