// Scenes of rigid bodies that are refused.
#include "base/errors.hpp"
#include "support.hpp"

namespace lockstep::test {
namespace {

using namespace test;
using ::testing::HasSubstr;

template <int dim>
std::string error(const std::string& content) {
  try {
    body<dim>(content);
  } catch (const InputError& failure) {
    return failure.what();
  }
  return "no error";
}

const std::string disc = geometry("ball", number("Radius", "0.2"));

TEST(RigidInput, Mass) {
  EXPECT_THAT(error<2>(disc), HasSubstr("\"body\" has no mass"));
  EXPECT_THAT(error<2>(disc + number("Density", "1") + number("Mass", "1")),
              HasSubstr("both \"Density\" and \"Mass\""));
  EXPECT_THAT(error<2>(disc + number("Surface Density", "1")),
              HasSubstr("is a volume, so it has no \"Surface Density\""));
  EXPECT_THAT(error<2>(disc + number("Density", "-1")), HasSubstr("Density"));
  EXPECT_EQ(error<2>(disc + motion("static")), "no error");
}

TEST(RigidInput, MassOfAShell) {
  const std::string plate = geometry("plate", numbers("Size", "4, 0") + text("Normal", "y")),
                    surface = number("Surface Density", "1"), density = number("Density", "1"),
                    thickness = number("Thickness", "0.1"), mass = number("Mass", "1");
  EXPECT_EQ(error<2>(plate + thickness + density), "no error");
  EXPECT_THAT(error<2>(plate), HasSubstr("give \"Surface Density\" or \"Mass\""));
  EXPECT_THAT(error<2>(plate + surface + thickness + density),
              HasSubstr("both \"Surface Density\" and \"Density\""));
  EXPECT_THAT(error<2>(plate + surface + thickness),
              HasSubstr("both \"Surface Density\" and \"Thickness\""));
  EXPECT_THAT(error<2>(plate + density), HasSubstr("but has no \"Thickness\""));
  EXPECT_THAT(error<2>(plate + thickness + mass), HasSubstr("but has no \"Density\""));
  EXPECT_THAT(error<2>(plate + thickness + density + mass),
              HasSubstr("both \"Density\" and \"Mass\""));
  EXPECT_THAT(error<2>(disc + thickness + density), HasSubstr("so it has no \"Thickness\""));
}

TEST(RigidInput, OwnCentreAndInertia) {
  const std::string ball = geometry("ball", number("Radius", "0.2")) + number("Mass", "1");
  EXPECT_THAT(error<2>(disc + number("Density", "1") + numbers("Center of Mass", "0, 0.1")),
              HasSubstr("has a \"Center of Mass\" of its own, but no \"Mass\""));
  EXPECT_THAT(error<2>(ball + number("Inertia", "0")), HasSubstr("Inertia"));
  EXPECT_THAT(error<2>(ball + number("Inertia", "1") + motion("static")),
              HasSubstr("follows a script, so it has no \"Inertia\""));
  EXPECT_THAT(error<3>(ball + numbers("Inertia", "1, 2")), HasSubstr("has 2 numbers"));
  EXPECT_THAT(error<3>(ball + numbers("Inertia", "1, 2, 3.1")),
              HasSubstr("larger than the sum of the others"));
  EXPECT_THAT(error<3>(ball + numbers("Inertia", "1, 1, 1, 2, 0, 0")),
              HasSubstr("has a principal moment of -1"));
  EXPECT_EQ(error<3>(ball + numbers("Inertia", "1, 2, 3")), "no error");  // a flat plate
}

TEST(RigidInput, Loads) {
  const std::string ball = disc + number("Mass", "1");
  const std::string push = texts("Force", "2*x, sin(t)");
  EXPECT_EQ(error<2>(ball + push), "no error");
  EXPECT_THAT(error<2>(disc + motion("static") + push), HasSubstr("cannot move it"));
  EXPECT_THAT(error<2>(ball + texts("Force", "z, 0")), HasSubstr("cannot evaluate \"z\""));
  EXPECT_THAT(error<2>(ball + texts("Force", "table(t, 0, 1), 0")),
              HasSubstr("wants a value for each of two or more times"));
  EXPECT_THAT(error<2>(ball + texts("Force", "1")), HasSubstr("has 1 component"));
}

TEST(RigidInput, Geometry) {
  const std::string mass = number("Mass", "1");
  EXPECT_THAT(error<2>(mass + geometry("ball", "")),
              HasSubstr("the shape \"ball\" needs \"Radius\""));
  EXPECT_THAT(error<2>(mass + geometry("box", numbers("Size", "1, 1") + number("Radius", "1"))),
              HasSubstr("the shape \"box\" has no \"Radius\""));
  EXPECT_THAT(error<2>(mass + geometry("torus", "")), HasSubstr("torus"));
  EXPECT_THAT(error<3>(mass + geometry("file", text("File", "absent.obj"))),
              HasSubstr("absent.obj"));
}

TEST(RigidInput, LocksAndMotions) {
  const std::string ball = disc + number("Mass", "1");
  EXPECT_THAT(error<2>(ball + texts("Locked", "z")), HasSubstr("rotation"));
  EXPECT_THAT(error<2>(ball + texts("Locked", "y") + numbers("Velocity", "0, 2")),
              HasSubstr("has \"y\" locked, but starts with a velocity of 2"));
  EXPECT_THAT(error<2>(disc + motion("static") + texts("Locked", "y")),
              HasSubstr("follows a script"));
  EXPECT_THAT(error<2>(disc + motion("static") + numbers("Velocity", "0, 2")),
              HasSubstr("but its motion is \"static\""));
  EXPECT_THAT(error<2>(disc + motion("table", numbers("Times", "0, 0"))),
              HasSubstr("must ascend, but 0 follows 0"));
  EXPECT_THAT(error<2>(disc + motion("table", numbers("Times", "0, 1") +
                                                  numbers("Displacements", "0, 1, 2"))),
              HasSubstr("has 3 numbers, but 2 times need 4"));
}

TEST(RigidInput, RotationIsAnAxisTimesAnAngle) {
  const std::string ball = disc + number("Mass", "1");
  const double right = 0.5 * M_PI;
  const auto turned = body<3>(ball + numbers("Rotation", "0, 0, 1.5707963267948966"));
  EXPECT_LE((turned.pose.orientation * Point<3>(1, 0, 0) - Point<3>(0, 1, 0)).norm(), 1e-15);
  EXPECT_NEAR(body<2>(ball + number("Rotation", "1.5707963267948966")).pose.orientation.angle(),
              right, 1e-15);
  EXPECT_THAT(error<3>(ball + numbers("Orientation", "1, 0, 0, 0")),
              HasSubstr("\"Orientation\" is called \"Rotation\" now"));
}

}  // namespace
}  // namespace lockstep::test
