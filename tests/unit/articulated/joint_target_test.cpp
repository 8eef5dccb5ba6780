// Targets of joints by the time: values and rates by hand.
#include <gtest/gtest.h>

#include <cmath>

#include "articulated/joint_target.hpp"
#include "base/errors.hpp"
#include "support/scene_text.hpp"

namespace lockstep::test {
namespace {

/// The target of a joint of n coordinates, from the content of its list in a scene.
JointTarget target(int n, const std::string& type, const std::string& content = "") {
  TargetRegistry targets("target");
  register_targets(targets);
  ParameterList schema("joint");
  declare_target(schema, n, targets);
  const ParameterList joint = scene_list(list("Target", text("Type", type) + content), schema);
  return read_target(joint, {n, "joint", Point<2>::Zero()}, targets);
}

TEST(JointTarget, ConstantRateGoesOnForEver) {
  const JointTarget shaft =
      target(1, "constant rate", number("Value", "0.25") + number("Velocity", "-7"));
  for (const double time : {0., 0.5, 100.}) {
    EXPECT_DOUBLE_EQ(shaft(time).q[0], 0.25 - 7 * time);
    EXPECT_EQ(shaft(time).rate[0], -7);
  }
}

TEST(JointTarget, EachCoordinateHasARateOfItsOwn) {
  const TargetValue at_2 = target(2, "constant rate", numbers("Velocity", "3, -0.5"))(2);
  EXPECT_EQ(at_2.q, Eigen::Vector2d(6, -1));
  EXPECT_EQ(at_2.rate, Eigen::Vector2d(3, -0.5));
}

TEST(JointTarget, AWaveLagsByThePlaceAlongItsDirection) {
  TargetRegistry targets("target");
  register_targets(targets);
  ParameterList schema("joint");
  declare_target(schema, 1, targets);
  const ParameterList joint = scene_list(
      list("Target", text("Type", "wave") + number("Amplitude", "0.5") + number("Frequency", "2") +
                         number("Wavelength", "4") + numbers("Direction", "0, 3")),
      schema);
  const double turn = 2 * pi * (2 * 0.3 - 1. / 4);
  const TargetValue value = read_target(joint, {1, "joint", Point<2>(7, 1)}, targets)(0.3);
  EXPECT_NEAR(value.q[0], 0.5 * std::sin(turn), 1e-14);
  EXPECT_NEAR(value.rate[0], 2 * pi * std::cos(turn), 1e-13);
}

TEST(JointTarget, OneThatGivesTooFewCoordinatesIsRefused) {
  TargetRegistry targets("target");
  targets.add(
      "constant", "Forgets how many it is asked for.", [](int) { return ParameterList(); },
      [](const ParameterList&, const TargetSetting&) {
        return [](double) {
          return TargetValue{Eigen::VectorXd::Zero(1), Eigen::VectorXd::Zero(1)};
        };
      });
  ParameterList joint("joint");
  declare_target(joint, 2, targets);
  const ParameterList validated = scene_list(list("Target", text("Type", "constant")), joint);
  EXPECT_THROW(read_target(validated, {2, "joint", Point<2>::Zero()}, targets), InputError);
  EXPECT_NO_THROW(read_target(validated, {1, "joint", Point<2>::Zero()}, targets));
}

}  // namespace
}  // namespace lockstep::test
