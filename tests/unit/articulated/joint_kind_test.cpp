// Joints alone: what each kind lets go and holds, by differences of poses.
#include <gmock/gmock.h>

#include "articulated/joint_promises.hpp"
#include "joint_types.hpp"
#include "motion/rotation.hpp"

namespace lockstep::test {
namespace {

template <int dim>
std::vector<std::pair<std::string, std::shared_ptr<const JointKind<dim>>>> shipped() {
  std::vector<std::pair<std::string, std::shared_ptr<const JointKind<dim>>>> all;
  for (const auto& type : shipped_joints<dim>())
    all.emplace_back(type.name, joint_kind<dim>(type.name));
  return all;
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

TYPED_TEST(OfDimension, KeepsItsPromises) {
  constexpr int dim = TypeParam::value;
  for (const auto& [name, kind] : shipped<dim>()) {
    for (const double size : {0., 1.}) {
      const auto q = Eigen::VectorXd::LinSpaced(kind->n_rates(), 0.4 * size, -0.7 * size);
      EXPECT_EQ(broken_promise<dim>(*kind, q), "") << name;
    }
  }
}

TYPED_TEST(OfDimension, RateRowsReadTheRates) {
  constexpr int dim = TypeParam::value;
  for (const auto& [name, kind] : shipped<dim>()) {
    const auto pose = kind->pose_of(Eigen::VectorXd::LinSpaced(kind->n_rates(), 0.4, -0.7));
    const auto free = kind->free_screws(pose), rows = kind->rate_rows(pose);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      for (std::size_t j = 0; j < free.size(); ++j)
        EXPECT_NEAR(rows[i].linear.dot(free[j].linear) + rows[i].angular.dot(free[j].angular),
                    i == j ? 1 : 0, 1e-14)
            << name;
    }
  }
}

/// A slider in the plane with one mistake.
class WrongSlider : public JointKind<2> {
 public:
  enum Mistake { none, start, row, gap_sign, screw, far_coordinates, few_gaps };
  explicit WrongSlider(Mistake mistake) : JointKind<2>({1, 0, 1}), mistake_(mistake) {}

  std::vector<Screw<2>> free_screws(const RelativePose<2>&) const override {
    Screw<2> free;
    free.linear = {mistake_ == screw ? 0.5 : 1, 0};
    return {free};
  }
  std::vector<Screw<2>> held_rows(const RelativePose<2>&) const override {
    Screw<2> across, turn;
    across.linear = {mistake_ == row ? 0.1 : 0, 1};
    turn.angular[0] = 1;
    return {across, turn};
  }
  Eigen::VectorXd gap(const RelativePose<2>& pose) const override {
    if (mistake_ == few_gaps)
      return Eigen::VectorXd::Constant(1, pose.offset.y());
    const double sign = mistake_ == gap_sign ? -1 : 1;
    return Eigen::Vector2d(sign * pose.offset.y(), angle_about_first(pose.rotation));
  }
  Eigen::VectorXd coordinates(const RelativePose<2>& pose, const Eigen::VectorXd&) const override {
    return Eigen::VectorXd::Constant(1, pose.offset.x() + (mistake_ == far_coordinates ? 1 : 0));
  }
  RelativePose<2> pose_of(const Eigen::VectorXd& q) const override {
    RelativePose<2> pose;
    pose.offset.x() = q[0] + (mistake_ == start ? 1 : 0);
    return pose;
  }

 private:
  Mistake mistake_;
};

TEST(JointKind, BrokenPromisesAreTold) {
  const auto broken = [](WrongSlider::Mistake mistake) {
    return broken_promise<2>(WrongSlider(mistake), Eigen::VectorXd::Zero(1));
  };
  EXPECT_EQ(broken(WrongSlider::none), "");
  EXPECT_THAT(broken(WrongSlider::start), testing::HasSubstr("sides that differ"));
  EXPECT_THAT(broken(WrongSlider::few_gaps), testing::HasSubstr("1 gaps for 2 held rows"));
  EXPECT_THAT(broken(WrongSlider::far_coordinates), testing::HasSubstr("other coordinates"));
  EXPECT_THAT(broken(WrongSlider::screw), testing::HasSubstr("free motion 1"));
  EXPECT_THAT(broken(WrongSlider::gap_sign), testing::HasSubstr("not held row 1"));
  EXPECT_THAT(broken(WrongSlider::row), testing::HasSubstr("held row 1"));
}

TEST(JointKind, AnglesCountWholeTurns) {
  const auto plane = joint_kind<2>("hinge");
  const auto space = joint_kind<3>("hinge");
  for (const double angle : {3., 7., 13., -20.}) {
    const Eigen::VectorXd q = Eigen::VectorXd::Constant(1, angle);
    const Eigen::VectorXd near = Eigen::VectorXd::Constant(1, angle + 1);
    EXPECT_NEAR(plane->coordinates(plane->pose_of(q), near)[0], angle, 1e-12);
    EXPECT_NEAR(space->coordinates(space->pose_of(q), near)[0], angle, 1e-12);
  }
}

/// The spin of the second side, in the axes of the first, is what a ball's rates are.
TEST(JointKind, ABallAdvancesByItsSpin) {
  const auto ball = joint_kind<3>("ball");
  const Eigen::Vector3d q(0.5, -0.3, 0.8), spin(0.1, 0.2, -0.3);
  const Eigen::Matrix3d expected =
      rotation_of<3>(spin).toRotationMatrix() * rotation_of<3>(q).toRotationMatrix();
  EXPECT_LT((ball->pose_of(ball->advanced(q, spin)).rotation - expected).norm(), 1e-14);
}

/// However often the ball went round, rates take it there by as many turns.
TEST(JointKind, WaysLeadToTheirGoal) {
  const auto ball = joint_kind<3>("ball");
  Eigen::VectorXd q(3);
  q << 0.4, -0.3, 0.2;
  const Point<3> axis = Point<3>(1, -0.6, 0.5).normalized();
  for (const double angle : {0.6, 3., 5., 9., 15.}) {
    const Eigen::VectorXd goal = angle * axis;
    const Eigen::VectorXd way = ball->change_to(q, goal);
    EXPECT_LT((ball->advanced(q, way) - goal).norm(), 1e-12) << angle;
    EXPECT_NEAR(way.norm(), (goal - q).norm(), 0.3) << angle;
  }
}

}  // namespace lockstep::test
