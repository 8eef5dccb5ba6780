// Prescribed motions: values by hand, velocities against differences.
#include "support.hpp"

namespace lockstep::test {
namespace {

using namespace test;

constexpr const char* round_shape = "ball";
const std::string radius = number("Radius", "0.2");

template <int dim>
void expect_derivative(const MotionScript<dim>& script, double time) {
  const double e = 1e-5;
  const ScriptedMotion<dim> before = script(time - e), now = script(time), after = script(time + e);
  EXPECT_LE(((after.displacement - before.displacement) / (2 * e) - now.velocity).norm(), 1e-7);
  EXPECT_LE(((after.turn - before.turn) / (2 * e) - now.angular_velocity).norm(), 1e-7);
}

TEST(Script, ConstantVelocity) {
  const auto b = body<3>(geometry(round_shape, radius) + motion("constant velocity") +
                         numbers("Velocity", "1, 2, 3") + numbers("Angular Velocity", "0, 0, 0.5"));
  EXPECT_FALSE(b.dynamic());
  EXPECT_EQ(b.mass, 0);
  EXPECT_EQ(b.script(2).displacement, Point<3>(2, 4, 6));
  EXPECT_EQ(b.script(2).turn, AngularVector<3>(0, 0, 1));
  expect_derivative(b.script, 0.7);
}

TEST(Script, Sinusoid) {
  const auto b = body<2>(
      geometry(round_shape, radius) +
      motion("sinusoid", numbers("Amplitude", "0.5, 0") + number("Angular Amplitude", "0.25") +
                             number("Frequency", "0.5") + number("Phase", "0.2")));
  // The phase is a quarter period at 0.5 - 0.2/pi seconds.
  const auto top = b.script(0.5 - 0.2 / pi);
  EXPECT_NEAR(top.displacement[0], 0.5, 1e-14);
  EXPECT_NEAR(top.turn[0], 0.25, 1e-14);
  EXPECT_NEAR(top.velocity[0], 0, 1e-14);
  expect_derivative(b.script, 0.3);
}

TEST(Script, TableHitsItsPointsWithoutOvershootAndRestsOutside) {
  const std::string rows = numbers("Times", "1, 2, 4, 5") +
                           numbers("Displacements", "0,0,0, 0,1,0, 0,1,0, 3,1,0") +
                           numbers("Angles", "0, 0.5, 0.5, -1") + numbers("Axis", "0, 2, 0");
  const auto script = body<3>(geometry(round_shape, radius) + motion("table", rows)).script;
  EXPECT_EQ(script(2).displacement, Point<3>(0, 1, 0));
  EXPECT_LE((script(3).displacement - Point<3>(0, 1, 0)).norm(), 1e-14);
  EXPECT_LE((script(5).turn - AngularVector<3>(0, -1, 0)).norm(), 1e-14);
  for (const double time : {1.2, 1.9, 2.5, 4.4, 4.9}) {
    expect_derivative(script, time);
    EXPECT_LE(script(time).displacement[1], 1 + 1e-14);
  }
  EXPECT_EQ(script(0.5).velocity.norm() + script(6).velocity.norm(), 0);
  EXPECT_EQ(script(6).displacement, script(5).displacement);
}

TEST(Script, TurnsAboutThePivotAndStartsWhereItsScriptIs) {
  // A plate along x from -1 to 1, hung at its left end, turned by a quarter at time 1.
  auto b = body<2>(
      geometry("plate", numbers("Size", "2, 0") + text("Normal", "y")) + numbers("Pivot", "-1, 0") +
      numbers("Position", "5, 5") +
      motion("table", numbers("Times", "0, 1") + numbers("Angles", "0, 1.5707963267948966")));
  EXPECT_EQ(b.pose.position, Point<2>(4, 5));
  move(b, RigidVector<2>(RigidVector<2>::Zero()), 0, 1);
  EXPECT_EQ(b.pose.position, Point<2>(4, 5));
  EXPECT_LE((b.pose.position + b.arm() - Point<2>(4, 6)).norm(), 1e-14);
  // The twist of the step: a rotation about the pivot.
  EXPECT_LE((b.last_move.velocity({6, 5}) - Point<2>(0, pi)).norm(), 1e-13);
}

}  // namespace
}  // namespace lockstep::test
