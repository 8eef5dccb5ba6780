// Masses, inertias and centres of mass against formulas.
#include "support.hpp"

namespace lockstep::test {
namespace {

using namespace test;

TEST(Mass, Ball) {
  const auto disc =
      body<2>(geometry("ball", number("Radius", "0.5")) + number("Density", "3"), 0.02);
  EXPECT_NEAR(disc.mass, 3 * pi * 0.25, 1e-12);
  EXPECT_NEAR(disc.inertia(0, 0), disc.mass * 0.25 / 2, 1e-3 * disc.mass);
  const auto ball =
      body<3>(geometry("ball", number("Radius", "0.5")) + number("Density", "3"), 0.05);
  EXPECT_NEAR(ball.mass, 3 * 4.0 / 3 * pi * 0.125, 1e-12);
  EXPECT_NEAR(ball.inertia(1, 1) / (0.4 * ball.mass * 0.25), 1, 5e-3);
  EXPECT_NEAR(ball.inertia(0, 1), 0, 1e-14);
}

TEST(Mass, Box) {
  const auto box = body<3>(geometry("box", numbers("Size", "1, 2, 3")) + number("Mass", "12"));
  EXPECT_NEAR(box.density, 2, 1e-12);
  EXPECT_NEAR(box.volume, 6, 1e-12);
  const Eigen::Vector3d expected(4 + 9, 1 + 9, 1 + 4);  // m (b^2 + c^2) / 12
  EXPECT_LE((box.inertia - Eigen::Matrix3d(expected.asDiagonal())).norm(), 1e-11);
}

TEST(Mass, Shells) {
  // A rod of mass 4 x 0.5 = 2 in 2D: m l^2 / 12.
  const auto rod = body<2>(geometry("plate", numbers("Size", "4, 0") + text("Normal", "y")) +
                           number("Surface Density", "0.5"));
  EXPECT_FALSE(rod.closed);
  EXPECT_NEAR(rod.mass, 2, 1e-13);
  EXPECT_NEAR(rod.inertia(0, 0), 2 * 16.0 / 12, 1e-12);
  EXPECT_EQ(rod.volume, 0);
  // A rod of the mass of the first, made of a sheet of 5 mm and 100 kg/m^2.
  const auto thick = body<2>(geometry("plate", numbers("Size", "4, 0") + text("Normal", "y")) +
                             number("Thickness", "0.005") + number("Density", "100"));
  EXPECT_NEAR(thick.density, 0.5, 1e-15);
  EXPECT_NEAR(thick.mass, 2, 1e-13);
  // A boat of 2 x 1 (bottom 2, walls 1 each): its centre of mass lies 1/4 above the bottom.
  const auto boat = body<2>(geometry("open box", numbers("Size", "2, 1")) + number("Mass", "1"));
  EXPECT_LE((boat.pose.position - Point<2>(0, -0.25)).norm(), 1e-13);
  EXPECT_EQ(boat.arm(), Point<2>(0, 0));
  // A closed surface as a shell: 4 pi r^2.
  const auto balloon = body<3>(geometry("ball", number("Radius", "1") +
                                                    "<Parameter name=\"Thin Shell\" type=\"bool\" "
                                                    "value=\"true\"/>") +
                               number("Surface Density", "2"));
  EXPECT_FALSE(balloon.closed);
  EXPECT_NEAR(balloon.mass / (8 * pi), 1, 1e-2);
}

TEST(Mass, MatrixAboutAPivotGivesThePhysicalMomentum) {
  const auto b = body<3>(geometry("box", numbers("Size", "1, 2, 3")) + number("Mass", "12") +
                         numbers("Pivot", "0.5, -1, 0") + numbers("Rotation", "0.5, 0.5, 0"));
  RigidVector<3> velocity;
  velocity << 1, -2, 0.5, 0.3, 0.8, -0.4;
  const RigidVector<3> momentum = mass_matrix(b, b.pose.orientation) * velocity;
  const AngularVector<3> omega = velocity.tail<3>();
  const Point<3> linear = 12 * (velocity.head<3>() + omega.cross(b.arm()));
  EXPECT_LE((momentum.head<3>() - linear).norm(), 1e-12);
  const Point<3> angular = b.arm().cross(linear) + world_inertia(b, b.pose.orientation) * omega;
  EXPECT_LE((momentum.tail<3>() - angular).norm(), 1e-12);
  EXPECT_LE((velocity_of(b, b.pose.orientation, momentum) - velocity).norm(), 1e-13);
}

TEST(Mass, OwnCentreAndInertia) {
  // A hull of mass 12 whose ballast lies low: its coordinates move to its own centre of mass.
  const std::string hull = geometry("box", numbers("Size", "4, 2")) + number("Mass", "12") +
                           numbers("Position", "1, 5") + number("Rotation", "1.5707963267948966");
  const auto ballasted =
      body<2>(hull + numbers("Center of Mass", "0.25, -0.5") + number("Inertia", "7"));
  EXPECT_NEAR(ballasted.mass, 12, 1e-13);
  EXPECT_NEAR(ballasted.density, 1.5, 1e-13);
  EXPECT_NEAR(ballasted.volume, 8, 1e-13);
  EXPECT_EQ(ballasted.inertia(0, 0), 7);
  EXPECT_EQ(ballasted.arm(), Point<2>(0, 0));  // joints may connect it
  EXPECT_LE((ballasted.center() - Point<2>(1.5, 5.25)).norm(), 1e-14);
  // The centroid of its surface stays where it was.
  const Point<2> centroid =
      ballasted.pose.position +
      ballasted.pose.orientation * volume_properties(ballasted.surface).centroid;
  EXPECT_LE((centroid - Point<2>(1, 5)).norm(), 1e-14);
  // Without an inertia it has that of an even spread, about its own centre.
  EXPECT_NEAR(body<2>(hull + numbers("Center of Mass", "0.25, -0.5")).inertia(0, 0),
              12 * (16. + 4.) / 12, 1e-12);

  const std::string box = geometry("box", numbers("Size", "1, 2, 3")) + number("Mass", "2");
  const auto moments = body<3>(box + numbers("Inertia", "3, 4, 5"));
  EXPECT_EQ(moments.inertia, Inertia<3>(Point<3>(3, 4, 5).asDiagonal()));
  const auto tensor = body<3>(box + numbers("Inertia", "3, 4, 5, 0.5, -0.25, 0.125") +
                              numbers("Center of Mass", "0, 0.1, -1"));
  Inertia<3> expected;
  expected << 3, 0.5, -0.25, 0.5, 4, 0.125, -0.25, 0.125, 5;
  EXPECT_EQ(tensor.inertia, expected);
  EXPECT_LE((tensor.center() - Point<3>(0, 0.1, -1)).norm(), 1e-15);
}

}  // namespace
}  // namespace lockstep::test
