// Impulses of limits: the complementarity problem against a search through all cases, and two
// limits of one velocity.
#include "contact/impulses/limit_impulses.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

#include "base/errors.hpp"

namespace lockstep::test {
namespace {

/// Tries which rows push.
Eigen::VectorXd by_search(const Eigen::MatrixXd& a, const Eigen::VectorXd& b) {
  const auto n = static_cast<int>(b.size());
  for (int choice = 0; choice < (1 << n); ++choice) {
    Eigen::MatrixXd rows = a;
    Eigen::VectorXd rhs = -b;
    for (int k = 0; k < n; ++k) {
      if ((choice >> k & 1) != 0)
        continue;
      rows.row(k) = Eigen::VectorXd::Unit(n, k).transpose();
      rhs[k] = 0;
    }
    const Eigen::VectorXd x = rows.fullPivLu().solve(rhs);
    if (x.minCoeff() >= -1e-12 && (a * x + b).minCoeff() >= -1e-12)
      return x;
  }
  return {};
}

TEST(LimitImpulses, Complementarity) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 200; ++trial) {
    const int n = 1 + trial % 8;
    const Eigen::MatrixXd half = Eigen::MatrixXd::NullaryExpr(n, n, [&] { return normal(random); });
    const Eigen::MatrixXd a = half * half.transpose() + 1e-3 * Eigen::MatrixXd::Identity(n, n);
    const Eigen::VectorXd b = Eigen::VectorXd::NullaryExpr(n, [&] { return normal(random); });
    const Eigen::VectorXd expected = by_search(a, b);
    ASSERT_EQ(expected.size(), n);
    EXPECT_LT((solve_complementarity(a, b) - expected).norm(), 1e-8 * (1 + expected.norm()));
  }
}

TEST(LimitImpulses, LargeSystems) {
  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  for (const int n : {30, 60}) {
    const Eigen::MatrixXd half = Eigen::MatrixXd::NullaryExpr(n, n, [&] { return normal(random); });
    const Eigen::MatrixXd a = half * half.transpose();
    const Eigen::VectorXd b = Eigen::VectorXd::NullaryExpr(n, [&] { return normal(random); });
    const Eigen::VectorXd x = solve_complementarity(a, b), rest = a * x + b;
    EXPECT_GE(x.minCoeff(), 0);
    EXPECT_GT(rest.minCoeff(), -1e-8);
    EXPECT_NEAR(x.dot(rest), 0, 1e-8 * x.norm());
  }
}

/// Limits of joints that loops tie together: many rows of few motions, each twice or with both of
/// its bounds, some of them reached already. At rest all are kept, so there is a solution; the
/// numbers are those with which an exchange of blocks or of single rows does not end.
TEST(LimitImpulses, DependentRows) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 3000; ++trial) {
    const int n = 2 + static_cast<int>(random() % 40), n_motions = std::max(1, n / 5);
    Eigen::MatrixXd rows =
        Eigen::MatrixXd::NullaryExpr(n, n_motions, [&] { return normal(random); });
    for (int k = n / 2; k < n && trial % 3 > 0; ++k)
      rows.row(k) = (trial % 3 == 1 ? -1 : 1) * rows.row(k - n / 2);
    Eigen::MatrixXd a = rows * rows.transpose();
    Eigen::VectorXd b =
        rows * Eigen::VectorXd::NullaryExpr(n_motions, [&] { return normal(random); });
    for (double& room : b)
      room += 0.5 * static_cast<double>(random() % 3);
    const Eigen::VectorXd x = solve_complementarity(a, b), rest = a * x + b;
    EXPECT_GE(x.minCoeff(), 0);
    EXPECT_GT(rest.minCoeff(), -1e-8);
    EXPECT_LT(std::abs(x.dot(rest)), 1e-8 * (1 + x.norm()));
  }
}

/// A row that no impulse moves, as where bounds of one motion leave nothing between them.
TEST(LimitImpulses, ContradictionIsSaid) {
  Eigen::MatrixXd a = Eigen::MatrixXd::Identity(3, 3);
  a(1, 1) = 0;
  try {
    solve_complementarity(a, Eigen::Vector3d(-1, -2, 3));
    FAIL();
  } catch (const SolveError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("one is left 2 m/s beyond"));
  }
}

/// One motion that is to be at least something and at most less.
TEST(LimitImpulses, ContradictionOfTwoLimitsIsSaid) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 500; ++trial) {
    const double gap = std::pow(10, -4 + 3e-3 * static_cast<double>(random() % 1000));
    const double least = normal(random), response = std::exp(normal(random));
    const auto limits = [&](double negligible) {
      LimitImpulses two;
      two.add({{{0, 1}}, {{0, response}}, least + gap});
      two.add({{{0, -1}}, {{0, -response}}, -least});
      std::vector<double> velocity{normal(random)};
      two.relax(velocity, negligible);
      return velocity[0];
    };
    EXPECT_THROW(limits(0), SolveError) << gap;
    EXPECT_THROW(limits(0.3 * gap), SolveError) << gap;
    EXPECT_NEAR(limits(1.1 * gap), least + gap / 2, gap) << gap;
  }
}

/// Two bodies of masses 1 and 2 whose difference of velocities has a lower and an upper bound.
TEST(LimitImpulses, BothLimitsOfOneVelocity) {
  LimitImpulses limits;
  limits.add({{{0, -1}, {1, 1}}, {{0, -1}, {1, 0.5}}, -0.1});
  limits.add({{{0, 1}, {1, -1}}, {{0, 1}, {1, -0.5}}, -0.2});
  for (const double difference : {-3., 0.1, 5.}) {
    LimitImpulses own = limits;
    std::vector<double> velocity{1, 1 + difference};
    own.relax(velocity);
    const double expected = difference < -0.1 ? -0.1 : difference > 0.2 ? 0.2 : difference;
    EXPECT_NEAR(velocity[1] - velocity[0], expected, 1e-10);
    EXPECT_NEAR(velocity[0] + 2 * velocity[1], 3 + 2 * difference, 1e-12);
    std::vector<double> impulse(2, 0);
    own.add_to(impulse);
    EXPECT_NEAR(impulse[0], velocity[0] - 1, 1e-12);
    EXPECT_LT(own.relax(velocity), 1e-10);
  }
}

}  // namespace
}  // namespace lockstep::test
