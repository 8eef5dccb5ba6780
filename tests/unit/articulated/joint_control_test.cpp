// Springs and dampers of joints alone.
#include <gtest/gtest.h>

#include "articulated/joint_control.hpp"
#include "joint_types.hpp"

namespace lockstep::test {
namespace {

JointControl sprung(double stiffness, double damping, double inertia) {
  JointControl control;
  control.coordinates.resize(1);
  control.coordinates[0].type = ControlType::proportional_derivative;
  control.coordinates[0].stiffness = stiffness;
  control.coordinates[0].damping = damping;
  control.coordinates[0].inertia = inertia;
  return control;
}

/// Half where omega dt is 4, whatever the units; of fourth order in dt where it is small.
TEST(JointControl, UnresolvedPartOfASpring) {
  EXPECT_DOUBLE_EQ(unresolved_part(sprung(16, 0, 1), 1), 0.5);
  EXPECT_DOUBLE_EQ(unresolved_part(sprung(400, 0, 1), 0.2), 0.5);
  EXPECT_DOUBLE_EQ(unresolved_part(sprung(800, 0, 2), 0.2), 0.5);
  const double coarse = unresolved_part(sprung(1, 0, 1), 0.2);
  EXPECT_NEAR(coarse / unresolved_part(sprung(1, 0, 1), 0.1), 16, 0.01);
  EXPECT_GT(unresolved_part(sprung(1e6, 0, 1), 1), 0.999);
}

TEST(JointControl, UnresolvedPartOfADamper) {
  EXPECT_DOUBLE_EQ(unresolved_part(sprung(0, 4, 1), 1), 0.5);
  EXPECT_EQ(unresolved_part(sprung(0, 0, 1), 1), 0);
}

TEST(JointControl, NoStepResolvesAJointWithoutInertia) {
  EXPECT_EQ(unresolved_part(sprung(1, 0, 0), 0.1), 1);
}

/// Torque at q + lead q': what a spring of 2 and a damper of 3 give for q = 1, q' = 5 and a target
/// of 0, with half of the damper at the present rate 4.
TEST(JointControl, LawOfASpringAndADamper) {
  JointControl control = sprung(2, 3, 1);
  const TargetValue present{Eigen::VectorXd::Constant(1, 1.), Eigen::VectorXd::Constant(1, 4.)};
  const ControlLaw law = control_law<2>(*joint_kind<2>("hinge"), control, present, {0, 0.1, 0.5});
  EXPECT_DOUBLE_EQ(law.constant[0] - law.slope[0] * 5, -2 * (1 + 0.1 * 5) - 3 * (4 + 5) / 2.);
}

}  // namespace
}  // namespace lockstep::test
