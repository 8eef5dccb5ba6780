// Levels of the water around bodies.
#include <gtest/gtest.h>

#include "liquid_cases.hpp"

namespace lockstep::test {
namespace {

template <int dim>
WaterLevel level_at_ball(const Point<dim>& gravity, double height) {
  Case<dim> scene(cube<dim>(20), 0.05);
  scene.fluid.set("Gravity", components<dim>(gravity));
  add_level<dim>(scene, height);
  Solids<dim> solids;
  solids.add(ball_surface<dim>(0.171, 0.05), Point<dim>::Constant(0.483), true);
  const auto fluid = make_liquid<dim>(scene);
  fluid->set_geometry(solids.snapshot(), BlockedFaces<dim>());
  return fluid->liquid()->levels_at_solids()[0];
}

/// However deep the ball is: from one that floats to one eight cells below.
template <int dim>
void expect_level_at_any_depth(const Point<dim>& up) {
  const double top = 0.483 * up.sum() + 0.171, h = 0.05;
  for (int i = -5; i <= 30; ++i) {
    const double height = top + 0.13 * i * h;
    const WaterLevel level = level_at_ball<dim>(-9.81 * up, height);
    EXPECT_TRUE(level.known) << i;
    EXPECT_TRUE(level.is_wet) << i;
    EXPECT_TRUE(level.pierces || i > 0) << i;
    EXPECT_NEAR(level.height, height, 1e-12) << i;
  }
  EXPECT_FALSE(level_at_ball<dim>(-9.81 * up, top + 8 * h).pierces);
}
TEST(LevelsAtSolids, AreThoseOfTheWater) {
  expect_level_at_any_depth<2>(Point<2>(0, 1));
  expect_level_at_any_depth<3>(Point<3>(0, 0, 1));
  expect_level_at_any_depth<2>(Point<2>(1, 1).normalized());
  expect_level_at_any_depth<3>(Point<3>(1, 1, 1).normalized());
}
TEST(LevelsAtSolids, AreUnknownWithoutGravity) {
  Case<2> scene({20, 20}, 0.05);
  add_ball<2>(scene, {0.5, 0.5}, 0.3);
  Solids<2> solids;
  solids.add(ball_surface<2>(0.171, 0.05), Point<2>(0.6, 0.7), true);
  const auto fluid = make_liquid<2>(scene);
  fluid->set_geometry(solids.snapshot(), BlockedFaces<2>());
  EXPECT_FALSE(fluid->liquid()->levels_at_solids()[0].known);
}

/// Deep inside of a body phi is what it once was: that of air, as when it still floated.
template <int dim>
void expect_no_air_inside() {
  Case<dim> scene(cube<dim>(20), 0.05);
  scene.fluid.set("Gravity", components<dim>(-9.81 * Point<dim>::Unit(1)));
  for (int side = 0; side < 2 * dim; ++side) {
    Point<dim> lower = Point<dim>::Constant(-1), upper = Point<dim>::Constant(2);
    (side % 2 == 0 ? upper : lower)[side / 2] = side % 2 == 0 ? 0.4 : 0.6;
    ParameterList& box = scene.fluid.sublist("Free Surface")
                             .sublist("Liquid")
                             .sublist("part " + std::to_string(side));
    box.set("Type", "box").set("Lower", components<dim>(lower));
    box.set("Upper", components<dim>(upper));
  }
  Solids<dim> solids;
  solids.add(box_surface<dim>(Point<dim>::Constant(0.41), 0.05), Point<dim>::Constant(0.49), true);
  const auto fluid = make_liquid<dim>(scene);
  fluid->set_geometry(solids.snapshot(), BlockedFaces<dim>());
  EXPECT_FALSE(fluid->liquid()->levels_at_solids()[0].pierces);
}
TEST(LevelsAtSolids, DoNotAskTheInsideOfSolids) {
  expect_no_air_inside<2>();
  expect_no_air_inside<3>();
}

// A block in an open box that stands in the water: what is beyond the box is not its level.
TEST(LevelsAtSolids, AreThoseInSight) {
  Case<2> scene({48, 48}, 0.1);
  scene.fluid.set("Gravity", numbers({0.0, -1.0}));
  for (const auto& [name, lower, upper, height] : {std::tuple{"left", -1.0, 1.0, 3.02},
                                                   {"inside", 1.0, 3.8, 1.63},
                                                   {"right", 3.8, 6.0, 3.02}}) {
    ParameterList& box = scene.fluid.sublist("Free Surface").sublist("Liquid").sublist(name);
    box.set("Type", "box").set("Lower", numbers({lower, -1.0}));
    box.set("Upper", numbers({upper, height}));
  }
  Solids<2> solids;
  solids.add(open_box_surface<2>(Point<2>(2.83, 3.03), 0.1), Point<2>(2.401, 2.301), false);
  solids.add(box_surface<2>(Point<2>(2.45, 0.6), 0.1), Point<2>(2.401, 1.6), true);
  const auto fluid = make_liquid<2>(scene);
  fluid->set_geometry(solids.snapshot(), BlockedFaces<2>());
  const WaterLevel level = fluid->liquid()->levels_at_solids()[1];
  EXPECT_TRUE(level.pierces);
  EXPECT_NEAR(level.height, 1.63, 0.01);
}

/// On the bottom of a dry hull, below the level of the sea around.
TEST(LevelsAtSolids, AreNotThoseBeyondADryHull) {
  Case<2> scene({48, 48}, 0.1);
  scene.fluid.set("Gravity", numbers({0.0, -1.0}));
  add_level<2>(scene, 3.02);
  scene.fluid.sublist("Free Surface").set("Dry Points", numbers({1.6, 2.0}));
  Solids<2> solids;
  solids.add(open_box_surface<2>(Point<2>(3.03, 2.03), 0.1), Point<2>(2.401, 2.601), false);
  solids.add(ball_surface<2>(0.4, 0.1), Point<2>(2.5, 2.03), true);
  solids.add(ball_surface<2>(0.4, 0.1), Point<2>(1.32, 3.02), true);
  const auto fluid = make_liquid<2>(scene);
  fluid->set_geometry(solids.snapshot(), BlockedFaces<2>());
  const std::vector<WaterLevel> levels = fluid->liquid()->levels_at_solids();
  EXPECT_TRUE(levels[0].is_wet);
  for (const int ball : {1, 2}) {
    EXPECT_FALSE(levels[ball].is_wet) << ball;
    EXPECT_TRUE(levels[ball].pierces) << ball;
  }
}

}  // namespace
}  // namespace lockstep::test
