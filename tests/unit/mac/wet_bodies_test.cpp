// Wet parts of bodies, near the surface and at periodic sides.
#include <gtest/gtest.h>

#include "liquid_cases.hpp"

namespace lockstep::test {
namespace {

template <int dim>
Case<dim> unit_cube_of_water(const Point<dim>& gravity, double height) {
  Case<dim> scene(cube<dim>(20), 0.05);
  scene.fluid.set("Gravity", components<dim>(gravity));
  add_level<dim>(scene, height);
  return scene;
}

/// True if a ball that the surface comes nearer to is partly wet; then its wet volume is checked.
template <int dim>
bool is_partly_wet(const Point<dim>& gravity, double height) {
  Case<dim> scene = unit_cube_of_water<dim>(gravity, height);
  Solids<dim> solids;
  solids.add(ball_surface<dim>(0.171, 0.05), Point<dim>::Constant(0.483), true);
  const auto fluid = make_liquid<dim>(scene);
  fluid->set_geometry(solids.snapshot(), BlockedFaces<dim>());
  const WetBody<dim> body = fluid->liquid()->wet_bodies()[0];
  EXPECT_EQ(body.partly, body.volume > 0) << height;
  return body.partly;
}

/// However deep it is: from one that floats to one eight cells below.
template <int dim>
void expect_balance_at_any_depth(const Point<dim>& up) {
  const double top = 0.483 * up.sum() + 0.171, h = 0.05;
  for (int i = -5; i <= 30; ++i)
    EXPECT_TRUE(is_partly_wet<dim>(-9.81 * up, top + 0.13 * i * h) || i > 0) << i;
  EXPECT_FALSE(is_partly_wet<dim>(-9.81 * up, top + 8 * h));
}
TEST(WetBodies, ThatTheSurfaceComesNearToAreWetToAKnownPart) {
  expect_balance_at_any_depth<2>(Point<2>(0, 1));
  expect_balance_at_any_depth<3>(Point<3>(0, 0, 1));
  expect_balance_at_any_depth<2>(Point<2>(1, 1).normalized());
  expect_balance_at_any_depth<3>(Point<3>(1, 1, 1).normalized());
}

/// Deep inside of a body phi is what it once was: that of air, as when it still floated.
template <int dim>
void expect_no_void_inside() {
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
  EXPECT_FALSE(fluid->liquid()->wet_bodies()[0].partly);
}
TEST(WetBodies, DoNotAskTheirInside) {
  expect_no_void_inside<2>();
  expect_no_void_inside<3>();
}

/// A box, and a thin plate at one end of the periodic axis or the other, with
/// no centre of a cell in it: what the plate blocks is the plate's, at its end.
template <int dim>
void expect_ends_of_their_own(double place) {
  const double h = 0.05;
  const Point<dim> up = Point<dim>::Unit(1);
  const auto bodies = [&](bool with_plate) {
    Case<dim> scene = unit_cube_of_water<dim>(-9.81 * up, 0.5 + 0.3 * h);
    scene.side("x lower", "periodic").side("x upper", "periodic");
    Solids<dim> solids;
    solids.add(box_surface<dim>(Point<dim>::Constant(0.41), h), Point<dim>::Constant(0.49), true);
    Point<dim> size = Point<dim>::Constant(0.41);
    size[0] = 0.3 * h;
    Point<dim> center = Point<dim>::Constant(0.49);
    center[0] = place;
    if (with_plate)
      solids.add(box_surface<dim>(size, h), center, true);
    const auto fluid = make_liquid<dim>(scene);
    fluid->set_geometry(solids.snapshot(), BlockedFaces<dim>());
    return fluid->liquid()->wet_bodies();
  };
  const WetBody<dim> box = bodies(false)[0];
  const auto both = bodies(true);
  EXPECT_NEAR(both[0].displaced[0], box.displaced[0], 1e-14);
  EXPECT_NEAR(both[0].moment[0][0], box.moment[0][0], 1e-14);
  // The plate blocks one layer of faces, four cells of which are in the water.
  const double displaced = std::pow(8 * h, dim - 2) * 4 * h * h;
  EXPECT_NEAR(both[1].displaced[0], displaced, 1e-14);
  EXPECT_NEAR(both[1].moment[0][0], displaced * (place < 0.5 ? 0 : 1), 1e-14);
}
TEST(WetBodies, AtPeriodicSidesAreNotWhatIsInBetween) {
  for (const double place : {0.25 * 0.05, 1 - 0.25 * 0.05}) {
    expect_ends_of_their_own<2>(place);
    expect_ends_of_their_own<3>(place);
  }
}

}  // namespace
}  // namespace lockstep::test
