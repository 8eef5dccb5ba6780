// Rotations and twists.
#include "support.hpp"

namespace lockstep::test {
namespace {

using test::followed;

TEST(Rotation, LogUndoesExp) {
  const Point<3> axis = Point<3>(1, -2, 0.5).normalized();
  for (const double angle : {0.0, 1e-12, 1e-5, 0.3, 2.0, 3.14}) {
    const AngularVector<3> turn = angle * axis;
    EXPECT_LE((rotation_vector<3>(rotation_of<3>(turn)) - turn).norm(), 1e-15 + 1e-14 * angle);
  }
  // More than half a turn comes back as the shorter one.
  EXPECT_LE((rotation_vector<3>(rotation_of<3>(4.0 * axis)) - (4.0 - 2 * pi) * axis).norm(), 1e-14);
  EXPECT_NEAR(rotation_vector<2>(rotation_of<2>(AngularVector<2>(4.0)))(0), 4.0 - 2 * pi, 1e-14);
}

TEST(Rotation, ExpTurnsByTheRightHandRule) {
  const Orientation<3> quarter = rotation_of<3>({0, 0, pi / 2});
  EXPECT_LE((quarter * Point<3>(1, 0, 0) - Point<3>(0, 1, 0)).norm(), 1e-15);
  EXPECT_LE((rotation_of<2>(AngularVector<2>(pi / 2)) * Point<2>(1, 0) - Point<2>(0, 1)).norm(),
            1e-15);
}

/// Follows the twist for dt from a point and compares with the rigid motion it stands for.
template <int dim>
void expect_flow(const AngularVector<dim>& turn, double dt) {
  Point<dim> origin = Point<dim>::Constant(0.3), displacement = Point<dim>::Constant(-0.7);
  origin[0] = -1.1;
  displacement[1] = 2;
  Point<dim> start = Point<dim>::Constant(0.9);
  start[0] = 0.2;
  const Point<dim> moved = followed(twist_of<dim>(origin, displacement, turn, dt), start, dt);
  const Point<dim> expected = origin + displacement + rotation_of<dim>(turn) * (start - origin);
  EXPECT_LE((moved - expected).norm(), 1e-9) << "turn of " << turn.norm();
}

TEST(Twist, ItsFlowIsTheRigidMotion) {
  for (const double angle : {0.0, 1e-6, 9e-3, 1.1e-2, 0.5, 2.0, 3.1, 3.3, 5.0, 9.0}) {
    expect_flow<2>(AngularVector<2>(-angle), 0.4);
    expect_flow<3>(angle * Point<3>(1, 2, -2) / 3, 0.4);
  }
}

TEST(Twist, OfATranslationIsItsVelocity) {
  const Twist<3> twist = twist_of<3>({1, 2, 3}, {0.5, 0, -1}, {0, 0, 0}, 0.5);
  EXPECT_EQ(twist.velocity({9, 9, 9}), Point<3>(1, 0, -2));
}

}  // namespace
}  // namespace lockstep::test
