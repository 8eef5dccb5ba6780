// Mechanisms that nothing acts on but their joints: what a step of any length keeps.
#include "articulated/free_motion.hpp"

#include <gtest/gtest.h>

#include "joint_types.hpp"
#include "motion/rotation.hpp"

namespace lockstep::test {
namespace {

/// Three boxes, 1 m x 0.2 m x 0.3 m, one behind the other on two balls.
class Chain {
 public:
  Chain() {
    const std::array<Point<3>, 3> spins{Point<3>(0.5, 0.7, 1), Point<3>(0, -0.6, -1),
                                        Point<3>(0.3, 0.4, 1.5)};
    const auto ball = joint_kind<3>("ball");
    for (int b = 0; b < 3; ++b) {
      JointedBody<3> body;
      body.first_dof = 6 * b;
      bodies_.push_back(body);
      poses_.push_back({Point<3>(b - 1., 0, 0), Axes<3>::Identity()});
      motions_.emplace_back();
      motions_[b].momentum.tail<3>() = moments().cwiseProduct(spins[b]);
    }
    for (int j = 0; j < 2; ++j) {
      Joint<3> joint;
      joint.kind = ball;
      joint.control.coordinates.resize(3);
      joint.q = Eigen::VectorXd::Zero(3);
      joint.sides[0] = {j, Point<3>(0.5, 0, 0)};
      joint.sides[1] = {j + 1, Point<3>(-0.5, 0, 0)};
      joints_.push_back(joint);
    }
    mechanism_ = find_mechanisms(bodies_, joints_)[0];
    hold();
  }

  bool fly_for(double dt, const FreeMotionSteps& steps) {
    const std::vector<BodyMass<3>> all = masses();
    const ClosingProblem<3> problem{mechanism_, joints_, poses_, poses_, all, dt};
    const auto free_motion = fly(problem, steps, motions_);
    if (!free_motion)
      return false;
    poses_ = poses_after(problem, free_motion->motions);
    for (int b = 0; b < 3; ++b)
      motions_[b].momentum += free_motion->given[b];
    hold();
    return true;
  }
  void turn_back() {
    for (BodyMotion<3>& motion : motions_)
      motion.momentum *= -1;
  }

  double fastest_turn() const {
    double fastest = 0;
    for (int b = 0; b < 3; ++b)
      fastest = std::max(fastest, velocity(b).tail<3>().norm());
    return fastest;
  }
  double energy() const {
    double sum = 0;
    for (int b = 0; b < 3; ++b)
      sum += 0.5 * motions_[b].momentum.dot(velocity(b));
    return sum;
  }
  /// Linear and, about the origin, angular momentum.
  TwistVector<3> momentum() const {
    TwistVector<3> sum = TwistVector<3>::Zero();
    for (int b = 0; b < 3; ++b) {
      sum += motions_[b].momentum;
      sum.tail<3>() += poses_[b].position.cross(Point<3>(motions_[b].momentum.head<3>()));
    }
    return sum;
  }
  double gap() const {
    return std::max(largest_gap(joints_[0], poses_), largest_gap(joints_[1], poses_));
  }
  const std::vector<BodyPose<3>>& poses() const { return poses_; }

 private:
  static Point<3> moments() { return Point<3>(0.13, 1.09, 1.04) / 12; }
  std::vector<BodyMass<3>> masses() const {
    std::vector<BodyMass<3>> all;
    for (const BodyPose<3>& pose : poses_) {
      BodyMass<3>::Matrix matrix = BodyMass<3>::Matrix::Identity();
      matrix.bottomRightCorner<3, 3>() =
          pose.rotation * moments().asDiagonal() * pose.rotation.transpose();
      all.push_back(mass_of<3>(matrix));
    }
    return all;
  }
  TwistVector<3> velocity(int body) const {
    return masses()[body].inverse * motions_[body].momentum;
  }
  void hold() {
    const std::vector<BodyMass<3>> all = masses();
    let_joints_hold<3>({mechanism_, joints_, poses_, poses_, all, 0}, motions_);
  }

  std::vector<JointedBody<3>> bodies_;
  std::vector<BodyPose<3>> poses_;
  std::vector<BodyMotion<3>> motions_;
  std::vector<Joint<3>> joints_;
  Mechanism mechanism_;
};

TEST(FreeMotion, KeepsEnergyAndMomentumAtAnyTurn) {
  for (const double turn : {0.1, 0.2, 0.5, 1., 2., 4.}) {
    Chain chain;
    const double energy = chain.energy(), dt = turn / chain.fastest_turn();
    const TwistVector<3> momentum = chain.momentum();
    double largest_change = 0;
    for (int step = 0; step < 20; ++step) {
      ASSERT_TRUE(chain.fly_for(dt, {4, 0.05}));
      largest_change = std::max(largest_change, std::abs(chain.energy() / energy - 1));
      EXPECT_LT(chain.gap(), 1e-9);
    }
    EXPECT_LT(largest_change, 3e-3) << turn;
    EXPECT_LT((chain.momentum() - momentum).norm(), 1e-11) << turn;
  }
}

TEST(FreeMotion, IsOfSecondOrder) {
  const auto end = [](int n_steps) {
    Chain chain;
    for (int step = 0; step < n_steps; ++step)
      EXPECT_TRUE(chain.fly_for(1. / n_steps, {}));
    return chain.poses()[2].position;
  };
  const Point<3> fine = end(640);
  const double coarse = (end(10) - fine).norm(), half = (end(20) - fine).norm();
  EXPECT_LT(half, 5e-3);
  EXPECT_NEAR(std::log2(coarse / half), 2, 0.15);
}

/// A free_motion is reversible, so that no energy can drift: with momenta turned round it goes back
/// the way it came.
TEST(FreeMotion, GoesBackTheWayItCame) {
  Chain chain;
  const std::vector<BodyPose<3>> start = chain.poses();
  for (int step = 0; step < 5; ++step)
    ASSERT_TRUE(chain.fly_for(0.2, {3}));
  EXPECT_GT((chain.poses()[2].position - start[2].position).norm(), 0.1);
  chain.turn_back();
  for (int step = 0; step < 5; ++step)
    ASSERT_TRUE(chain.fly_for(0.2, {3}));
  for (int b = 0; b < 3; ++b) {
    EXPECT_LT((chain.poses()[b].position - start[b].position).norm(), 1e-9);
    EXPECT_LT((chain.poses()[b].rotation - start[b].rotation).norm(), 1e-9);
  }
}

}  // namespace
}  // namespace lockstep::test
