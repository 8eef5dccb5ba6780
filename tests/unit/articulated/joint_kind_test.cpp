// Joints alone: what each kind lets go and holds, by differences of poses.
#include <gtest/gtest.h>

#include "articulated/joint_kind.hpp"
#include "motion/rotation.hpp"

namespace lockstep::test {
namespace {

template <int dim>
Eigen::VectorXd some_coordinates(const JointKind& kind) {
  return Eigen::VectorXd::LinSpaced(n_rates<dim>(kind), 0.4, -0.7);
}

/// The pose after a small motion of the second side: along and about the axes of the first.
template <int dim>
RelativePose<dim> pushed(const RelativePose<dim>& pose, const Screw<dim>& screw, double by) {
  const AngularVector<dim> turn = by * screw.angular;
  return {pose.offset + by * screw.linear,
          rotation_of<dim>(turn).toRotationMatrix() * pose.rotation};
}

template <int dim>
double product(const Screw<dim>& row, const Screw<dim>& motion) {
  return row.linear.dot(motion.linear) + row.angular.dot(motion.angular);
}

template <int n>
struct Dimension {
  static constexpr int value = n;
};
template <typename D>
class OfDimension : public ::testing::Test {};
using Dimensions = ::testing::Types<Dimension<2>, Dimension<3>>;
TYPED_TEST_SUITE(OfDimension, Dimensions);

}  // namespace

TYPED_TEST(OfDimension, FreeMotionsOpenNoGap) {
  constexpr int dim = TypeParam::value;
  for (const DescribedKind& one : joint_kinds<dim>()) {
    const JointKind& kind = one.kind;
    const RelativePose<dim> pose = pose_of<dim>(kind, some_coordinates<dim>(kind));
    EXPECT_LT(gap(kind, pose).norm(), 1e-14) << kind.name;
    for (const Screw<dim>& free : free_screws(kind, pose)) {
      EXPECT_LT(gap(kind, pushed(pose, free, 1e-4)).norm(), 1e-7) << kind.name;
      for (const Screw<dim>& held : held_rows(kind, pose))
        EXPECT_NEAR(product(held, free), 0, 1e-14) << kind.name;
    }
  }
}

TYPED_TEST(OfDimension, RowsAndRatesCountAllMotions) {
  constexpr int dim = TypeParam::value;
  for (const DescribedKind& one : joint_kinds<dim>()) {
    const RelativePose<dim> pose = pose_of<dim>(one.kind, some_coordinates<dim>(one.kind));
    const auto held = held_rows(one.kind, pose);
    EXPECT_EQ(held.size() + n_rates<dim>(one.kind), std::size_t(dim + n_rotations<dim>))
        << one.kind.name;
    EXPECT_EQ(held.size(), std::size_t(gap(one.kind, pose).size())) << one.kind.name;
  }
}

TYPED_TEST(OfDimension, HeldRowsAreTheRatesOfGaps) {
  constexpr int dim = TypeParam::value;
  constexpr double by = 1e-6;
  for (const DescribedKind& one : joint_kinds<dim>()) {
    const RelativePose<dim> pose = pose_of<dim>(one.kind, some_coordinates<dim>(one.kind));
    const auto held = held_rows(one.kind, pose);
    for (std::size_t k = 0; k < held.size(); ++k) {
      const Eigen::VectorXd opened = gap(one.kind, pushed(pose, held[k], by)) / by;
      for (std::size_t r = 0; r < held.size(); ++r)
        EXPECT_NEAR(opened[static_cast<int>(r)], product(held[r], held[k]), 1e-5) << one.kind.name;
    }
  }
}

TYPED_TEST(OfDimension, RateRowsReadTheRates) {
  constexpr int dim = TypeParam::value;
  for (const DescribedKind& one : joint_kinds<dim>()) {
    const RelativePose<dim> pose = pose_of<dim>(one.kind, some_coordinates<dim>(one.kind));
    const auto free = free_screws(one.kind, pose), rows = rate_rows(one.kind, pose);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      for (std::size_t j = 0; j < free.size(); ++j)
        EXPECT_NEAR(product(rows[i], free[j]), i == j ? 1 : 0, 1e-14) << one.kind.name;
    }
  }
}

TYPED_TEST(OfDimension, CoordinatesAreThoseOfThePose) {
  constexpr int dim = TypeParam::value;
  for (const DescribedKind& one : joint_kinds<dim>()) {
    const Eigen::VectorXd q = some_coordinates<dim>(one.kind);
    const RelativePose<dim> pose = pose_of<dim>(one.kind, q);
    EXPECT_LT((coordinates(one.kind, pose, q) - q).norm(), 1e-14) << one.kind.name;
    EXPECT_LT(distance_to(one.kind, pose, q).norm(), 1e-14) << one.kind.name;
  }
}

TEST(JointKind, AnglesCountWholeTurns) {
  const JointKind hinge{"hinge", {}, JointTurn::axis};
  for (const double angle : {3., 7., 13., -20.}) {
    const Eigen::VectorXd q = Eigen::VectorXd::Constant(1, angle);
    const Eigen::VectorXd near = Eigen::VectorXd::Constant(1, angle + 1);
    EXPECT_NEAR(coordinates(hinge, pose_of<2>(hinge, q), near)[0], angle, 1e-12);
    EXPECT_NEAR(coordinates(hinge, pose_of<3>(hinge, q), near)[0], angle, 1e-12);
  }
}

/// The spin of the second side, in the axes of the first, is what a ball's rates are.
TEST(JointKind, ABallAdvancesByItsSpin) {
  const JointKind ball{"ball", {}, JointTurn::any};
  const Eigen::Vector3d q(0.5, -0.3, 0.8), spin(0.1, 0.2, -0.3);
  const Eigen::Matrix3d expected =
      rotation_of<3>(spin).toRotationMatrix() * rotation_of<3>(q).toRotationMatrix();
  EXPECT_LT((pose_of<3>(ball, advanced<3>(ball, q, spin)).rotation - expected).norm(), 1e-14);
}

/// However often the ball went round, rates take it there by as many turns.
TEST(JointKind, WaysLeadToTheirGoal) {
  const JointKind ball{"ball", {}, JointTurn::any};
  Eigen::VectorXd q(3);
  q << 0.4, -0.3, 0.2;
  const Point<3> axis = Point<3>(1, -0.6, 0.5).normalized();
  for (const double angle : {0.6, 3., 5., 9., 15.}) {
    const Eigen::VectorXd goal = angle * axis;
    const Eigen::VectorXd way = change_to<3>(ball, q, goal);
    EXPECT_LT((advanced<3>(ball, q, way) - goal).norm(), 1e-12) << angle;
    EXPECT_NEAR(way.norm(), (goal - q).norm(), 0.3) << angle;
  }
}

}  // namespace lockstep::test
