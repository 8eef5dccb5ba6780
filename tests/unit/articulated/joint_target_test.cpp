// Targets of joints by the time: values and rates by hand.
#include <gtest/gtest.h>

#include "articulated/joint_target.hpp"
#include "support/scene_text.hpp"

namespace lockstep::test {
namespace {

/// The target of a joint of n coordinates, from the content of its list in a scene.
JointTarget target(int n, const std::string& type, const std::string& content = "") {
  ParameterList schema("joint");
  declare_target(schema, n);
  const ParameterList joint = scene_list(list("Target", text("Type", type) + content), schema);
  return read_target(
      joint, n, [](const ParameterArray<double>&) { return 0.; }, "joint");
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

}  // namespace
}  // namespace lockstep::test
